// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/scene/load_options.h"
#include "core/scene/scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fieldcast::scene {

/// The canonical bundle: every file a scene is made of (glTF, buffers, images, environment) with its relative path,
/// and the import options, in one byte string. Its SHA-256 is the scene hash; FetchScene sends it.
std::vector<std::byte> make_bundle(const std::filesystem::path& file, const LoadOptions& options);

SceneHash hash_bundle(std::span<const std::byte> bundle);
std::string to_hex(const SceneHash& hash);

/// Checks a bundle from outside and unpacks it into `folder` (created; nothing outside it is written).
/// Returns what load_scene needs. Paths that are absolute, contain ".." or name a scheme are refused.
struct UnpackedBundle {
    std::filesystem::path file;
    LoadOptions options;
};
Decoded<UnpackedBundle> unpack_bundle(std::span<const std::byte> bundle, const std::filesystem::path& folder);

} // namespace fieldcast::scene
