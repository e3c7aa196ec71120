// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

#include <filesystem>
#include <optional>

namespace fieldcast::scene {

/// What may be in a scene; anything beyond is refused before it is allocated.
struct SceneLimits {
    std::uint64_t max_triangles = 64ULL << 20; ///< over all meshes, not instances
    std::uint64_t max_image_pixels = 1ULL << 26;
    std::uint64_t max_total_image_pixels = 1ULL << 30;
    std::uint64_t max_file_bytes = 4ULL << 30;
};

struct LoadOptions {
    std::optional<std::filesystem::path> environment; ///< .hdr or .exr, equirectangular
    glm::vec3 sky{0.5F, 0.7F, 1.0F};                  ///< linear radiance when there is no environment image
    SceneLimits limits;
};

/// Loads a .gltf or .glb file with everything it refers to.
/// Throws UserError naming file, object and reason ("lamp.gltf: accessor 12: 900 bytes beyond buffer view 3").
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

} // namespace fieldcast::scene
