// SPDX-License-Identifier: Apache-2.0
#include "core/scene/scene_extent.h"

#include "core/scene/load_report.h"

#include <algorithm>

namespace fieldcast::scene {

namespace {

constexpr int kAnimationSamples = 16;

struct Box {
    glm::vec3 low{0.0F};
    glm::vec3 high{0.0F};
};

Box bounds(const Mesh& mesh) {
    Box box{mesh.positions.front(), mesh.positions.front()};
    for (const glm::vec3& position : mesh.positions) {
        box.low = glm::min(box.low, position);
        box.high = glm::max(box.high, position);
    }
    return box;
}

/// Whether all coordinates are within kMaxExtent_m; false for NaN.
bool is_near(const glm::vec3& v) {
    const glm::vec3 a = glm::abs(v);
    return a.x <= kMaxExtent_m && a.y <= kMaxExtent_m && a.z <= kMaxExtent_m;
}

bool is_near(const glm::mat4& matrix, const Box& box) {
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::vec3 local((corner & 1U) != 0 ? box.high.x : box.low.x, (corner & 2U) != 0 ? box.high.y : box.low.y,
                              (corner & 4U) != 0 ? box.high.z : box.low.z);
        if (!is_near(glm::vec3(matrix * glm::vec4(local, 1.0F)))) {
            return false;
        }
    }
    return true;
}

[[noreturn]] void refuse_node(const Scene& scene, std::uint32_t node) {
    refuse(scene.name, object_name("node", node, scene.nodes[node].name),
           "reaches farther than 1e9 m from the origin, or its transform is not finite; move or scale it");
}

/// `only_animated`: checks animated nodes only; the others have been checked before.
void check_pose(const Scene& scene, const ScenePose& pose, const std::vector<Box>& boxes, bool only_animated) {
    for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const glm::mat4& matrix = pose.world_from_node[i];
        const bool is_wanted = !only_animated || scene.nodes[i].is_animated;
        if (is_wanted && !is_near(matrix, {glm::vec3(0.0F), glm::vec3(1.0F)})) {
            refuse_node(scene, i);
        }
    }
    for (const Instance& instance : scene.instances) {
        const bool is_wanted = !only_animated || scene.nodes[instance.node].is_animated;
        if (is_wanted && !is_near(pose.world_from_node[instance.node], boxes[instance.mesh])) {
            refuse_node(scene, instance.node);
        }
    }
}

} // namespace

void check_extent(const Scene& scene) {
    if (scene.instances.empty()) {
        refuse(scene.name, "scene", "shows no triangles; at least one node needs a mesh with triangles");
    }
    std::vector<Box> boxes;
    boxes.reserve(scene.meshes.size());
    std::transform(scene.meshes.begin(), scene.meshes.end(), std::back_inserter(boxes), bounds);
    check_pose(scene, pose_scene(scene, 0), boxes, false);
    for (int i = 1; i <= kAnimationSamples && !scene.channels.empty(); ++i) {
        const double time_s = scene.duration_s * i / kAnimationSamples;
        check_pose(scene, pose_scene(scene, static_cast<std::int64_t>(time_s * 1e9)), boxes, true);
    }
}

} // namespace fieldcast::scene
