// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace fieldcast::image {

/// Writes `bytes` to a hidden temporary file beside `file` and renames it: readers see the old file or the new one,
/// never a part, also when the process is interrupted. Throws std::system_error.
void write_file_atomically(const std::filesystem::path& file, std::span<const std::byte> bytes);

} // namespace fieldcast::image
