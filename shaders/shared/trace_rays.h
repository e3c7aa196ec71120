// SPDX-License-Identifier: Apache-2.0
// Parameters of the ray benchmark and test kernels trace_rays_closest and trace_rays_any.
#ifndef FIELDCAST_SHARED_TRACE_RAYS_H
#define FIELDCAST_SHARED_TRACE_RAYS_H
#include "types.h"

SHARED_BEGIN

const uint kBindRays = 0; // set 1: TraceRay, a texel buffer of RGBA32F

struct TraceRay {
    vec3 origin;    // world space, metres
    float t_max;    // in lengths of `direction`
    vec3 direction;
    float t_min;
};

// What trace_rays_closest writes, one per ray; trace_rays_any writes the transmittance, one float per ray.
struct TraceHit {
    float t;
    uint instance;
    uint primitive;
};
SHARED_BUFFER(TraceHitBuffer, TraceHit);

struct TraceRaysParams {
    TraceHitBuffer hits;        // out of trace_rays_closest
    FloatBuffer transmittances; // out of trace_rays_any
    uint ray_count;
    uint mode;                  // kTrace… of lib/traversal.glsl
    uint seed;
    uint unused;
};

SHARED_END
#endif
