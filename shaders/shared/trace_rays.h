// SPDX-License-Identifier: Apache-2.0
// Rays of the benchmark and test kernels trace_rays_*.
#ifndef FIELDCAST_SHARED_TRACE_RAYS_H
#define FIELDCAST_SHARED_TRACE_RAYS_H
#include "types.h"

SHARED_BEGIN

const uint kTraceRaysGroup = 64u; // rays per workgroup
const uint kBindRays = 0u;        // set 1: TraceRay, a texel buffer of RGBA32F

struct TraceRay {
    vec3 origin;    // world space, metres
    float t_max;    // in lengths of `direction`
    vec3 direction;
    float t_min;
};

struct TraceHit {
    float t;
    uint instance;  // kNoInstance: nothing
    uint primitive;
};
SHARED_BUFFER(TraceHitBuffer, TraceHit);

struct TraceRaysParams {
    TraceHitBuffer hits;        // out of trace_rays_closest, one per ray
    FloatBuffer transmittances; // out of trace_rays_any, one per ray
    uint ray_count;
    uint mode;                  // kTrace… of lib/traversal.glsl
    uint seed;
    uint unused;
};

SHARED_END
#endif
