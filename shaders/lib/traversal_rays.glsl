// SPDX-License-Identifier: Apache-2.0
// Rays and results of the kernels trace_rays_* (shared/trace_rays.h).
#ifndef FIELDCAST_LIB_TRAVERSAL_RAYS
#define FIELDCAST_LIB_TRAVERSAL_RAYS
#include "lib/traversal.glsl"
#include "shared/trace_rays.h"

layout(local_size_x = kTraceRaysGroup) in;
layout(set = 1, binding = kBindRays) uniform samplerBuffer rays_;
layout(push_constant, scalar) uniform Push { TraceRaysParams params; };

TraceRay load_ray(uint index) {
    vec4 a = texelFetch(rays_, int(index * 2u));
    vec4 b = texelFetch(rays_, int(index * 2u) + 1);
    return TraceRay(a.xyz, a.w, b.xyz, b.w);
}

void find_closest(uint index) {
    if (index < params.ray_count) {
        TraceRay ray = load_ray(index);
        Hit hit = trace_closest(ray.origin, ray.direction, ray.t_min, ray.t_max, params.mode, params.seed);
        params.hits.at[index] = TraceHit(hit.t, hit.instance, hit.primitive);
    }
}

void find_any(uint index) {
    if (index < params.ray_count) {
        TraceRay ray = load_ray(index);
        params.transmittances.at[index] = trace_transmittance(ray.origin, ray.direction, ray.t_max);
    }
}

#endif
