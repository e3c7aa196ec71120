// SPDX-License-Identifier: Apache-2.0
#include "bench/speed/rays.h"

#include "core/lightfield/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <random>

namespace fieldcast::bench {

namespace {

constexpr std::uint32_t kTilePx = 8;
constexpr std::uint32_t kSeed = 20220701;
constexpr float kFar = std::numeric_limits<float>::max();

/// Moves a point away from its surface by a few rounding errors of its position.
glm::vec3 offset_point(const glm::vec3& point, const glm::vec3& normal) {
    const glm::vec3 magnitude = glm::max(glm::abs(point), glm::vec3(1.0F));
    return point + normal * 3e-6F * std::max({magnitude.x, magnitude.y, magnitude.z});
}

std::vector<shared::TraceRay> primary_rays(const Camera& camera) {
    std::vector<shared::TraceRay> rays;
    const glm::vec3 origin(camera.world_from_camera[3]);
    for (std::uint32_t tile_y = 0; tile_y < camera.height_px; tile_y += kTilePx) {
        for (std::uint32_t tile_x = 0; tile_x < camera.width_px; tile_x += kTilePx) {
            for (std::uint32_t y = tile_y; y < std::min(tile_y + kTilePx, camera.height_px); ++y) {
                for (std::uint32_t x = tile_x; x < std::min(tile_x + kTilePx, camera.width_px); ++x) {
                    const glm::vec2 centre(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
                    rays.push_back({origin, kFar, glm::normalize(unproject(camera, centre, 1.0F) - origin), 0.0F});
                }
            }
        }
    }
    return rays;
}

glm::vec3 cosine_direction(const glm::vec3& normal, float u, float v) {
    const float radius = std::sqrt(u);
    const float angle = glm::two_pi<float>() * v;
    const glm::vec3 helper = std::abs(normal.x) > 0.5F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 tangent = glm::normalize(glm::cross(helper, normal));
    const glm::vec3 bitangent = glm::cross(normal, tangent);
    return glm::normalize(tangent * radius * std::cos(angle) + bitangent * radius * std::sin(angle) +
                          normal * std::sqrt(1.0F - u));
}

/// Direction to the first directional light; straight up if there is none.
glm::vec3 sun_direction(const scene::Scene& scene, const scene::ScenePose& pose) {
    for (const scene::Light& light : scene.lights) {
        if (light.type == scene::LightType::kDirectional) {
            return glm::normalize(glm::vec3(pose.world_from_node[light.node][2]));
        }
    }
    return {0.0F, 1.0F, 0.0F};
}

} // namespace

RaySets make_rays(const scene::Scene& scene, const scene::ScenePose& pose, const scene::CameraNode& camera_node,
                  const EmbreeTracer& tracer, std::uint32_t width_px, std::uint32_t height_px) {
    RaySets sets;
    const glm::mat4 world_from_camera = scene::camera_pose(pose, camera_node);
    sets.primary = primary_rays(make_camera(world_from_camera, camera_node.fovy_rad, width_px, height_px));
    const glm::vec3 sun = sun_direction(scene, pose);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    for (const shared::TraceRay& ray : sets.primary) {
        const SurfaceHit hit = tracer.closest(ray);
        if (hit.instance == scene::kNone) {
            continue;
        }
        const glm::vec3 normal = glm::dot(hit.normal, ray.direction) > 0.0F ? -hit.normal : hit.normal;
        const glm::vec3 origin = offset_point(ray.origin + hit.t * ray.direction, normal);
        const float u = uniform(random);
        sets.bounce.push_back({origin, kFar, cosine_direction(normal, u, uniform(random)), 0.0F});
        sets.shadow.push_back({origin, kFar, sun, 0.0F});
    }
    return sets;
}

} // namespace fieldcast::bench
