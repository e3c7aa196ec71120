// SPDX-License-Identifier: Apache-2.0
#include "core/image/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <unistd.h>

namespace fieldcast::image {

namespace {

/// Unique among the threads of this process and among processes that write into the same folder.
std::filesystem::path temporary_name(const std::filesystem::path& file) {
    static std::atomic<unsigned> counter{0};
    std::string name = file.filename().string();
    name.insert(name.begin(), '.');
    name.append(".").append(std::to_string(getpid())).append(".").append(std::to_string(counter++)).append(".part");
    return file.parent_path() / name;
}

void write_all(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    errno = 0;
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
        throw std::system_error(errno != 0 ? errno : EIO, std::generic_category(), "cannot write " + file.string());
    }
}

} // namespace

void replace_file(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& write) {
    const std::filesystem::path part = temporary_name(file);
    try {
        write(part);
        std::filesystem::rename(part, file);
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw;
    }
}

void write_file_atomically(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    replace_file(file, [&](const std::filesystem::path& part) { write_all(part, bytes); });
}

} // namespace fieldcast::image
