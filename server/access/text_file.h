// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <sys/types.h>

namespace fieldcast::access {

/// All of a file of at most `max_bytes`. Throws UserError naming it.
std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes);

/// Tells whether a file was replaced or rewritten. Follows links, so that a swapped folder counts.
struct FileStamp {
    std::int64_t modified_ns = 0;
    std::int64_t changed_ns = 0; ///< also by chmod, and by writers that set the time of modification back
    std::int64_t bytes = -1; ///< -1: it could not be looked at
    ino_t inode = 0;
    dev_t device = 0;

    bool operator==(const FileStamp&) const = default;
};
FileStamp stamp_of(const std::filesystem::path& file);

/// Anybody on this machine may write to it.
bool is_writable_by_all(const std::filesystem::path& file);

} // namespace fieldcast::access
