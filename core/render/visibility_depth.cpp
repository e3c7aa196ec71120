// SPDX-License-Identifier: Apache-2.0
#include "core/render/visibility_depth.h"

#include "shaders/shared/scene.h"

#include <limits>

namespace fieldcast::render {

std::vector<float> depth_of_visibility(const scene::GpuScene& gpu_scene, const Camera& camera,
                                       std::span<const glm::uvec2> visibility) {
    const scene::Scene& scene = gpu_scene.scene();
    const auto& world_from_node = gpu_scene.current_pose().world_from_node;
    const glm::vec3 origin(camera.world_from_camera[3]);
    std::vector<float> depth(visibility.size(), std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < visibility.size(); ++i) {
        const glm::uvec2 seen = visibility[i];
        if (seen.x == shared::kNoInstance) {
            continue;
        }
        const scene::Instance& instance = scene.instances[seen.x];
        const scene::Mesh& mesh = scene.meshes[instance.mesh];
        const glm::uvec3 corners = mesh.triangles[seen.y];
        const auto place = [&](std::uint32_t corner) {
            return glm::vec3(world_from_node[instance.node] * glm::vec4(mesh.positions[corner], 1.0F));
        };
        const glm::vec3 p0 = place(corners.x);
        const glm::vec3 normal = glm::cross(place(corners.y) - p0, place(corners.z) - p0);
        const glm::vec2 pixel(static_cast<float>(i % camera.width_px) + 0.5F,
                              static_cast<float>(i / camera.width_px) + 0.5F);
        const glm::vec3 ray = unproject(camera, pixel, 1.0F) - origin; // scaled to a view depth of 1
        depth[i] = glm::dot(p0 - origin, normal) / glm::dot(ray, normal);
    }
    return depth;
}

} // namespace fieldcast::render
