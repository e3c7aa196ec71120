// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

namespace fieldcast::image {

/// Calls `write` with the name of a hidden temporary file beside `file`, then renames that file. Readers see the old
/// file or the new one, never a part, even if the process is interrupted. Removes the temporary file if `write` throws.
/// Throws what `write` throws, and std::system_error.
void replace_file(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& write);

/// Replaces `file` with `bytes` in the same way. Throws std::system_error.
void write_file_atomically(const std::filesystem::path& file, std::span<const std::byte> bytes);

} // namespace fieldcast::image
