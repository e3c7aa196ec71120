#version 460
// SPDX-License-Identifier: Apache-2.0
// Triangles of one rigid group in one view. A triangle's first vertex numbers it.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

layout(location = 0) in uvec4 vertex; // bits of the position; the triangle's number
layout(location = 0) flat out uint number;
layout(push_constant, scalar) uniform Push { DrawParams params; };

void main() {
    gl_Position = params.clip_from_group * vec4(uintBitsToFloat(vertex.xyz), 1.0);
    number = vertex.w;
}
