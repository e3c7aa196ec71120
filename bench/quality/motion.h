// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/correspondence.h"
#include "core/scene/scene.h"

namespace fieldcast::bench {

/// Motion of a scene's instances between two moments.
struct Motion {
    std::vector<glm::mat4> before_from_now; ///< by instance
    std::vector<bool> is_moving;            ///< by instance: its transform has changed
};

Motion find_motion(const scene::Scene& scene, const scene::ScenePose& before, const scene::ScenePose& now);

/// Pixels that show a moving instance, and pixels within `radius_px` rows and columns of one, where moving objects
/// cause artefacts. `surfaces` contains instances as objects.
std::vector<bool> moving_mask(const image::ViewSurfaces& surfaces, const std::vector<bool>& is_moving,
                              std::uint32_t radius_px);

} // namespace fieldcast::bench
