// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/speed/embree_tracer.h"
#include "core/scene/scene.h"
#include "shaders/shared/trace_rays.h"

#include <vector>

namespace fieldcast::bench {

/// Rays of each kind, in the image order of their pixels.
struct RaySets {
    std::vector<shared::TraceRay> primary; ///< of the scene's camera, 8×8 pixel tiles one after the other
    std::vector<shared::TraceRay> bounce;  ///< cosine-distributed from every primary hit
    std::vector<shared::TraceRay> shadow;  ///< from every primary hit towards the sun
};

/// Rays through a `width_px` × `height_px` image of `camera`. Deterministic: the same arguments give the same rays.
RaySets make_rays(const scene::Scene& scene, const scene::ScenePose& pose, const scene::CameraNode& camera,
                  const EmbreeTracer& tracer, std::uint32_t width_px, std::uint32_t height_px);

} // namespace fieldcast::bench
