// SPDX-License-Identifier: Apache-2.0
#include "core/scene/rigid_groups.h"

#include <glm/gtc/matrix_transform.hpp>
#include <map>

namespace fieldcast::scene {

namespace {

glm::mat4 local_transform(const Node& node) {
    if (node.matrix) {
        return *node.matrix;
    }
    const glm::mat4 translated = glm::translate(glm::mat4(1.0F), node.translation);
    return glm::scale(translated * glm::mat4_cast(node.rotation), node.scale);
}

/// For every node, the nearest node that an animation channel moves: itself or an ancestor; kNone for static nodes.
std::vector<std::uint32_t> movers(const Scene& scene) {
    std::vector<std::uint32_t> mover(scene.nodes.size(), kNone);
    for (const AnimationChannel& channel : scene.channels) {
        mover[channel.node] = channel.node;
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const std::uint32_t parent = scene.nodes[i].parent;
        if (mover[i] == kNone && parent != kNone) {
            mover[i] = mover[parent];
        }
    }
    return mover;
}

glm::mat4 mover_from_node(const Scene& scene, std::uint32_t mover, std::uint32_t node) {
    glm::mat4 result(1.0F);
    for (; node != mover; node = scene.nodes[node].parent) {
        result = local_transform(scene.nodes[node]) * result;
    }
    return result;
}

} // namespace

std::vector<RigidGroup> rigid_groups(const Scene& scene, const ScenePose& pose) {
    const std::vector<std::uint32_t> mover = movers(scene);
    std::vector<RigidGroup> groups;
    std::map<std::uint32_t, std::size_t> group_of_mover;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const std::uint32_t instance_node = scene.instances[i].node;
        const std::uint32_t node = mover[instance_node];
        const auto [found, is_new] = group_of_mover.try_emplace(node, groups.size());
        if (is_new) {
            groups.push_back({node, {}});
        }
        const glm::mat4 transform =
            node == kNone ? pose.world_from_node[instance_node] : mover_from_node(scene, node, instance_node);
        groups[found->second].parts.push_back({i, transform});
    }
    return groups;
}

} // namespace fieldcast::scene
