// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/bundle.h"

#include <filesystem>
#include <optional>

namespace fieldcast::client::play {

/// Writes `entry.json` into the folder of an unpacked scene: the file to load, and its options. Call it last, because
/// `entry.json` marks the folder as complete. Throws std::system_error.
void write_cache_entry(const std::filesystem::path& folder, const scene::UnpackedBundle& unpacked);

/// Reads `entry.json`. Nothing if it is missing or malformed, or if it names files outside the folder.
std::optional<scene::UnpackedBundle> read_cache_entry(const std::filesystem::path& folder);

} // namespace fieldcast::client::play
