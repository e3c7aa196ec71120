// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

#include <memory>
#include <optional>

namespace fieldcast::scene {

/// Where a ray ends.
struct ProbeHit {
    float distance_m = 0.0F;
    bool is_front = false; ///< the triangle's front (counter-clockwise) side was hit
};

/// Rays on the CPU, to get to know a scene before it is rendered. Every triangle is solid. Memory: about 100 bytes per
/// triangle of each mesh that is shown.
class RayProbe {
public:
    /// The scene at that pose.
    RayProbe(const Scene& scene, const ScenePose& pose);
    ~RayProbe();
    RayProbe(const RayProbe&) = delete;
    RayProbe& operator=(const RayProbe&) = delete;

    /// The nearest triangle along a direction of unit length; nothing if there is none.
    std::optional<ProbeHit> trace(const glm::vec3& from, const glm::vec3& direction) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::scene
