// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/ray_probe.h"

#include <optional>
#include <string>
#include <utility>

// Camera placement for scenes whose file has no camera.
namespace fieldcast::scene {

/// Values that the user prescribes; the others follow from the scene.
struct FramingOptions {
    std::optional<glm::vec3> look_from{}; ///< world space, metres
    std::optional<glm::vec3> look_at{};
    std::optional<float> fovy_rad{}; ///< vertical
    std::optional<double> orbit_s{}; ///< seconds per turn of the camera around its subject

    bool any() const { return look_from || look_at || fovy_rad || orbit_s; }
};

/// A camera position (world space, metres) and its subject.
struct Framing {
    glm::vec3 from{0.0F};
    glm::vec3 at{0.0F}; ///< the subject; differs from `from`
    float fovy_rad = 0.0F;
    bool is_inside = false; ///< the camera stands in a room
};

/// Lowest and highest corner (world space, metres) of the scene's bounding box at the beginning of the animation.
std::pair<glm::vec3, glm::vec3> extent_of(const Scene& scene);

inline constexpr const char* kFramingCamera = "auto"; ///< name of the camera that add_camera() adds

/// Frames the whole scene from the front, right and above. If probe rays show that the scene is a room, the camera
/// stands inside at eye height and looks along the longest free direction. `aspect`: width over height of the image.
/// The scene must show at least one triangle (check_extent()).
Framing find_framing(const Scene& scene, const RayProbe& probe, const FramingOptions& options, float aspect);

/// Adds a camera node with this framing at the end of `scene.cameras`. With `orbit_s` it makes a whole number of turns
/// during the longest animation, and the scene lasts at least one turn.
void add_camera(Scene& scene, const Framing& framing, std::optional<double> orbit_s);

/// Quantiles 5, 50 and 95 % of the depths (−Z, metres) over a camera's pixels that show a surface.
struct DepthRange {
    float near_m = 0.0F;
    float middle_m = 0.0F;
    float far_m = 0.0F;
};

/// Estimates the range with a coarse grid of rays; nothing if less than a twentieth of the rays hit a surface.
std::optional<DepthRange> depth_range(const RayProbe& probe, const glm::mat4& world_from_camera, float fovy_rad,
                                      float aspect);

/// Largest disparity between the outermost views of a grid, as a share of their width, that comfortable_spacing()
/// allows for depths from `near_m` to `far_m`. The benchmark scenes, whose spacing was chosen by hand, have 3 to 8 %.
inline constexpr float kComfortableDisparity = 0.05F;

/// Distance of neighbouring views, metres, for `count` views in a row that converge at `convergence_m` (infinity:
/// parallel). 0 for a single view.
float comfortable_spacing(const DepthRange& depths, float convergence_m, std::uint32_t count, float fovy_rad,
                          float aspect);

} // namespace fieldcast::scene
