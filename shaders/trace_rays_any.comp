#version 460
// SPDX-License-Identifier: Apache-2.0
// Finds what is left of the light along each ray of a buffer; for tests and `bench trace`.
#extension GL_GOOGLE_include_directive : require
#include "lib/traversal.glsl"
#include "lib/surface.glsl"
#include "shared/trace_rays.h"

layout(local_size_x = 64) in;
layout(set = 1, binding = kBindRays) uniform samplerBuffer rays_;
layout(push_constant, scalar) uniform Push { TraceRaysParams params; };

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= params.ray_count) {
        return;
    }
    vec4 a = texelFetch(rays_, int(index * 2u));
    vec4 b = texelFetch(rays_, int(index * 2u) + 1);
    params.transmittances.at[index] = trace_transmittance(a.xyz, b.xyz, a.w);
}
