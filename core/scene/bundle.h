// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/error.h"
#include "core/scene/load_options.h"
#include "core/scene/scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace fieldcast::scene {

/// The canonical bundle: one byte string with every file of a scene (glTF, buffers, images, environment), its relative
/// path, and the import options. Its SHA-256 is the scene hash; FetchScene sends the bundle. Throws UserError.
std::vector<std::byte> make_bundle(const std::filesystem::path& file, const LoadOptions& options);

SceneHash hash_bundle(std::span<const std::byte> bundle);
std::string to_hex(const SceneHash& hash);

/// Arguments of load_scene() for an unpacked bundle.
struct UnpackedBundle {
    std::filesystem::path file;
    LoadOptions options;
};
/// Checks a bundle from outside and unpacks it into `folder`, which is created and must be empty. Nothing outside it is
/// written. Refuses paths that are absolute, contain ".." or name a scheme.
Decoded<UnpackedBundle> unpack_bundle(std::span<const std::byte> bundle, const std::filesystem::path& folder);

} // namespace fieldcast::scene
