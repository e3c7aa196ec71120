// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"

#include <memory>
#include <optional>

namespace fieldcast::scene {

/// The nearest intersection of a ray.
struct ProbeHit {
    float distance_m = 0.0F;
    bool is_front = false; ///< the triangle's front (counter-clockwise) side was hit
};

/// Traces rays on the CPU, to measure a scene before it is rendered. Every triangle is opaque. Memory: about 100 bytes
/// per triangle of each mesh that is shown.
class RayProbe {
public:
    /// Builds the acceleration structure of the scene in `pose`.
    RayProbe(const Scene& scene, const ScenePose& pose);
    ~RayProbe();
    RayProbe(const RayProbe&) = delete;
    RayProbe& operator=(const RayProbe&) = delete;

    /// The nearest hit along a direction of unit length; nothing if the ray misses.
    std::optional<ProbeHit> trace(const glm::vec3& from, const glm::vec3& direction) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::scene
