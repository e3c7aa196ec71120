// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform sampler2DArray texture_layers;
layout(push_constant, scalar) uniform Push {
    Vec4Buffer places; // u, v, layer, level of detail
    Vec4Buffer colours;
};

void main() {
    const uint index = gl_GlobalInvocationID.x;
    const vec4 place = places.at[index];
    colours.at[index] = textureLod(texture_layers, place.xyz, place.w);
}
