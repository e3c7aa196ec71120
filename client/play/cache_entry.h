// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/bundle.h"

#include <filesystem>
#include <optional>

namespace fieldcast::client::play {

/// Remembers, inside the folder of an unpacked scene, which file to load and with which options: `entry.json`.
/// Written last, so its presence says that the folder is complete. Throws std::system_error.
void write_cache_entry(const std::filesystem::path& folder, const scene::UnpackedBundle& unpacked);

/// Nothing if the folder holds no entry, or one that is malformed or points outside the folder.
std::optional<scene::UnpackedBundle> read_cache_entry(const std::filesystem::path& folder);

} // namespace fieldcast::client::play
