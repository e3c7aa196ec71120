// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>

namespace fieldcast::scene {

/// Limits of a scene. The loader refuses a scene that exceeds them before it allocates memory.
struct SceneLimits {
    std::uint64_t max_triangles = 64ULL << 20; ///< over all meshes; instances are not counted
    std::uint64_t max_image_pixels = 1ULL << 26;
    std::uint64_t max_total_image_pixels = 1ULL << 30;
    std::uint64_t max_file_bytes = 4ULL << 30;
};

/// Environment of a scene without an environment image.
enum class Surroundings : std::uint8_t {
    kSky,           ///< the constant `LoadOptions::sky`
    kStudio,        ///< soft lights in a grey room (core/scene/studio.h)
    kStudioIfUnlit, ///< the studio if the file has no light and no emissive material, else the sky
};

/// Options of load_scene().
struct LoadOptions {
    std::optional<std::filesystem::path> environment; ///< .hdr or .exr, equirectangular
    Surroundings surroundings = Surroundings::kSky;   ///< used without `environment`
    glm::vec3 sky{0.5F, 0.7F, 1.0F};                  ///< linear radiance of the constant sky
    SceneLimits limits;
};

} // namespace fieldcast::scene
