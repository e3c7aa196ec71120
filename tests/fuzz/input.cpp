// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/input.h"

#include "core/base/error.h"

#include <algorithm>
#include <fstream>
#include <unistd.h>

namespace fieldcast::fuzz {

namespace {

struct ScratchFolder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("fieldcast_fuzz_" + std::to_string(::getpid()));

    ScratchFolder() { std::filesystem::create_directories(path); }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
};

} // namespace

std::uint8_t Reader::take_byte() {
    const Bytes byte = take(1);
    return byte.empty() ? std::uint8_t{0} : std::to_integer<std::uint8_t>(byte[0]);
}

Bytes Reader::take(std::size_t count) {
    const Bytes taken = bytes_.first(std::min(count, bytes_.size()));
    bytes_ = bytes_.subspan(taken.size());
    return taken;
}

Bytes Reader::take_piece() {
    const std::size_t low = take_byte();
    return take(low | static_cast<std::size_t>(take_byte()) << 8);
}

std::string_view as_text(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string as_piece(std::string_view bytes) {
    FC_ASSERT(bytes.size() <= 0xFFFF, "two bytes for the size");
    return std::string{static_cast<char>(bytes.size() & 0xFF), static_cast<char>(bytes.size() >> 8)} +
           std::string(bytes);
}

const std::filesystem::path& scratch_folder() {
    static const ScratchFolder folder;
    return folder.path;
}

std::filesystem::path scratch_file(const std::string& name, Bytes bytes) {
    std::filesystem::path file = scratch_folder() / name;
    std::ofstream stream(file, std::ios::binary);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return file;
}

bool is_refused(const std::function<void()>& read) {
    try {
        read();
        return false;
    } catch (const UserError& error) {
        FC_ASSERT(!std::string_view(error.what()).empty(), "a refusal says why");
        return true;
    }
}

} // namespace fieldcast::fuzz
