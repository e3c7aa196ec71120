// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/camera.h"

#include <cmath>

namespace fieldcast {

Camera make_camera(const glm::mat4& world_from_camera, float fovy_rad, std::uint32_t width_px,
                   std::uint32_t height_px) {
    Camera camera;
    camera.world_from_camera = world_from_camera;
    camera.width_px = width_px;
    camera.height_px = height_px;
    camera.focal_px = 0.5F * static_cast<float>(height_px) / std::tan(0.5F * fovy_rad);
    camera.principal_px = 0.5F * glm::vec2(static_cast<float>(width_px), static_cast<float>(height_px));
    return camera;
}

Camera with_guard_band(const Camera& camera, const GuardBand& band) {
    Camera widened = camera;
    widened.width_px += band.left_px + band.right_px;
    widened.height_px += band.top_px + band.bottom_px;
    widened.principal_px += glm::vec2(static_cast<float>(band.left_px), static_cast<float>(band.top_px));
    return widened;
}

float vertical_fov(const Camera& camera) {
    return 2.0F * std::atan(0.5F * static_cast<float>(camera.height_px) / camera.focal_px);
}

glm::vec3 project(const Camera& camera, const glm::vec3& world) {
    const glm::mat3 rotation(camera.world_from_camera);
    const glm::vec3 p = glm::transpose(rotation) * (world - glm::vec3(camera.world_from_camera[3]));
    const float depth = -p.z;
    return {camera.principal_px.x + camera.focal_px * p.x / depth,
            camera.principal_px.y - camera.focal_px * p.y / depth, depth};
}

glm::vec3 unproject(const Camera& camera, const glm::vec2& pixel, float depth_m) {
    const glm::vec2 slope = (pixel - camera.principal_px) / camera.focal_px;
    const glm::vec4 local(slope.x * depth_m, -slope.y * depth_m, -depth_m, 1.0F);
    return glm::vec3(camera.world_from_camera * local);
}

} // namespace fieldcast
