#version 460
// SPDX-License-Identifier: Apache-2.0
#extension GL_EXT_scalar_block_layout : require

layout(location = 0) in vec4 place;
layout(location = 1) in uint number;
layout(location = 0) flat out uint first;
layout(push_constant, scalar) uniform Push {
    vec2 moved;
    uint added;
};

void main() {
    gl_Position = vec4(place.xy + moved, place.zw);
    first = number;
}
