#version 460
// SPDX-License-Identifier: Apache-2.0
#extension GL_EXT_scalar_block_layout : require

layout(constant_id = 7) const uint kFactor = 1u;
layout(location = 0) flat in uint first;
layout(location = 0) out uint number;
layout(location = 1) out uint mark;
layout(push_constant, scalar) uniform Push {
    vec2 moved;
    uint added;
};

void main() {
    number = first * kFactor + added;
    mark = 3u;
}
