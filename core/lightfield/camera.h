// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace fieldcast {

/// Pixels added around an image. They extend the field of view of the same pinhole camera.
struct GuardBand {
    std::uint32_t left_px = 0;
    std::uint32_t right_px = 0;
    std::uint32_t top_px = 0;
    std::uint32_t bottom_px = 0;

    bool operator==(const GuardBand&) const = default;
};

/// Pinhole camera with square pixels. Looks along −Z, +Y up; pixel (0,0) is top left, pixel centres at +0.5.
/// A guard band and an off-axis (sheared) frustum only move the principal point and change the size.
///
///   pixel x = principal_px.x + focal_px · X / depth        depth = −Z > 0, metres
///   pixel y = principal_px.y − focal_px · Y / depth
struct Camera {
    glm::mat4 world_from_camera{1.0F}; ///< rigid: rotation and translation only
    float focal_px = 1.0F;
    glm::vec2 principal_px{0.0F};
    std::uint32_t width_px = 1;
    std::uint32_t height_px = 1;

    bool operator==(const Camera&) const = default;
};

/// A camera without guard band or shear. `fovy_rad` is the vertical field of view, in (0, π).
Camera make_camera(const glm::mat4& world_from_camera, float fovy_rad, std::uint32_t width_px, std::uint32_t height_px);

/// `camera` with `band` more pixels around the same image.
Camera with_guard_band(const Camera& camera, const GuardBand& band);

/// Vertical field of view of an image without guard band, radians.
float vertical_fov(const Camera& camera);

/// Image position of a world point, pixels; z = depth along the viewing axis in metres (≤ 0: behind the camera).
glm::vec3 project(const Camera& camera, const glm::vec3& world);

/// World point seen at image position `pixel` (centres at +0.5) at view depth `depth_m`.
glm::vec3 unproject(const Camera& camera, const glm::vec2& pixel, float depth_m);

} // namespace fieldcast
