// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/scene.h"
#include "shaders/shared/trace_rays.h"

#include <memory>
#include <span>

namespace fieldcast::bench {

struct SurfaceHit {
    float t = 0.0F;
    std::uint32_t instance = scene::kNone;
    std::uint32_t primitive = 0;
    glm::vec3 normal{0.0F}; ///< geometric, unit length, world space
};

/// The baseline: Embree with one flattened scene in world space, one ray at a time, all surfaces opaque.
class EmbreeTracer {
public:
    EmbreeTracer(const scene::Scene& scene, const scene::ScenePose& pose);
    ~EmbreeTracer();
    EmbreeTracer(const EmbreeTracer&) = delete;
    EmbreeTracer& operator=(const EmbreeTracer&) = delete;

    SurfaceHit closest(const shared::TraceRay& ray) const;

    /// Calls rtcIntersect1 for every ray on `threads` threads, which take chunks dynamically. Returns seconds.
    double trace_closest(std::span<const shared::TraceRay> rays, std::span<shared::TraceHit> hits,
                         std::uint32_t threads) const;
    /// Does the same with rtcOccluded1; writes 0 (blocked) or 1. Returns seconds.
    double trace_any(std::span<const shared::TraceRay> rays, std::span<float> transmittances,
                     std::uint32_t threads) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::bench
