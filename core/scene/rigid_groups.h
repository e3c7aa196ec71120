// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

namespace fieldcast::scene {

/// An instance and its transform into the space of its group.
struct RigidPart {
    std::uint32_t instance = 0;
    glm::mat4 group_from_object{1.0F};
};

/// Instances that never move relative to each other (docs/decisions/0004).
struct RigidGroup {
    std::uint32_t node = kNone; ///< node whose transform places the group; kNone: static, in world space
    std::vector<RigidPart> parts;
};

/// Groups of all instances: one for all static instances, and one for each node that an animation channel moves. They
/// are ordered by their first instances.
std::vector<RigidGroup> rigid_groups(const Scene& scene, const ScenePose& pose);

} // namespace fieldcast::scene
