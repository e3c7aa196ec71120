// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <sys/types.h>

namespace fieldcast::access {

/// Content of a file. Throws UserError that names the file if it is unreadable or larger than `max_bytes`.
std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes);

/// Identifies a version of a file: it differs after the file was replaced or rewritten. Links are followed, so a
/// changed link to a folder is noticed, too.
struct FileStamp {
    std::int64_t modified_ns = 0;
    std::int64_t changed_ns = 0; ///< ctime: covers chmod and writers that reset the time of modification
    std::int64_t bytes = -1; ///< size; -1: the file cannot be examined
    ino_t inode = 0;
    dev_t device = 0;

    bool operator==(const FileStamp&) const = default;
};
FileStamp stamp_of(const std::filesystem::path& file);

/// Whether all users of this machine may write to the file.
bool is_writable_by_all(const std::filesystem::path& file);

} // namespace fieldcast::access
