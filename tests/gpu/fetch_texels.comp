// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"

layout(local_size_x = 16) in;
layout(set = 0, binding = 0) uniform usamplerBuffer integers;
layout(set = 0, binding = 1) uniform samplerBuffer floats;
layout(push_constant, scalar) uniform Push { FloatBuffer sums; };

void main() {
    const uint index = gl_GlobalInvocationID.x;
    const uvec4 whole = texelFetch(integers, int(index));
    const vec2 real = texelFetch(floats, int(index)).xy;
    sums.at[index] = float(whole.x + whole.y + whole.z + whole.w) + real.x + real.y;
}
