// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/correspondence.h"
#include "core/scene/scene.h"

namespace fieldcast::bench {

/// World transforms of a scene's instances from one moment to another.
struct Motion {
    std::vector<glm::mat4> before_from_now; ///< by instance
    std::vector<bool> is_moving;            ///< by instance: was elsewhere, or turned otherwise, before
};

Motion find_motion(const scene::Scene& scene, const scene::ScenePose& before, const scene::ScenePose& now);

/// Pixels that show a moving instance, and those within `radius_px` rows and columns of one: the surroundings are where
/// a moving object leaves its traces. `surfaces` names instances as objects.
std::vector<bool> moving_mask(const image::ViewSurfaces& surfaces, const std::vector<bool>& is_moving,
                              std::uint32_t radius_px);

} // namespace fieldcast::bench
