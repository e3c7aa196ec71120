// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>

namespace fieldcast::scene {

/// What may be in a scene; anything beyond is refused before it is allocated.
struct SceneLimits {
    std::uint64_t max_triangles = 64ULL << 20; ///< over all meshes, not instances
    std::uint64_t max_image_pixels = 1ULL << 26;
    std::uint64_t max_total_image_pixels = 1ULL << 30;
    std::uint64_t max_file_bytes = 4ULL << 30;
};

/// What surrounds a scene where no environment image is named.
enum class Surroundings : std::uint8_t {
    kSky,           ///< the constant `LoadOptions::sky`
    kStudio,        ///< soft lights in a grey room (core/scene/studio.h)
    kStudioIfUnlit, ///< the studio if the file has no light and nothing that emits, else the sky
};

struct LoadOptions {
    std::optional<std::filesystem::path> environment; ///< .hdr or .exr, equirectangular
    Surroundings surroundings = Surroundings::kSky;   ///< without `environment`
    glm::vec3 sky{0.5F, 0.7F, 1.0F};                  ///< linear radiance of the constant sky
    SceneLimits limits;
};

} // namespace fieldcast::scene
