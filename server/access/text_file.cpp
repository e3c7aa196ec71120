// SPDX-License-Identifier: Apache-2.0
#include "server/access/text_file.h"

#include "core/base/error.h"

#include <fstream>
#include <sys/stat.h>

namespace fieldcast::access {

std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes) {
    std::ifstream stream(file, std::ios::binary);
    std::error_code error;
    if (!stream || !std::filesystem::is_regular_file(file, error)) {
        throw UserError(file.string() + ": cannot be read");
    }
    std::string text(max_bytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > max_bytes) {
        throw UserError(file.string() + ": is larger than " + std::to_string(max_bytes) + " bytes");
    }
    return text;
}

FileStamp stamp_of(const std::filesystem::path& file) {
    struct stat facts {};
    if (stat(file.c_str(), &facts) != 0) {
        return {};
    }
    constexpr std::int64_t kNanoseconds = 1'000'000'000;
    return {.modified_ns = facts.st_mtim.tv_sec * kNanoseconds + facts.st_mtim.tv_nsec,
            .changed_ns = facts.st_ctim.tv_sec * kNanoseconds + facts.st_ctim.tv_nsec,
            .bytes = facts.st_size,
            .inode = facts.st_ino,
            .device = facts.st_dev};
}

bool is_writable_by_all(const std::filesystem::path& file) {
    struct stat facts {};
    return stat(file.c_str(), &facts) == 0 && (facts.st_mode & S_IWOTH) != 0;
}

} // namespace fieldcast::access
