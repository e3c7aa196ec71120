// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

namespace fieldcast::scene {

/// An instance in the space of its group.
struct RigidPart {
    std::uint32_t instance = 0;
    glm::mat4 group_from_object{1.0F};
};

/// Instances that never move against each other (docs/decisions/0004).
struct RigidGroup {
    std::uint32_t node = kNone; ///< whose transform places the group; kNone: it stands still in world space
    std::vector<RigidPart> parts;
};

/// All instances: those that stand still as one group, and one group for each node that an animation channel moves. In
/// the order of their first instances.
std::vector<RigidGroup> rigid_groups(const Scene& scene, const ScenePose& pose);

} // namespace fieldcast::scene
