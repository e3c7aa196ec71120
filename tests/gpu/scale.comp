// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const float kFactor = 1.0;
layout(constant_id = 2) const bool kNegate = false;
layout(push_constant, scalar) uniform Push {
    Vec3Buffer from;
    Vec3Buffer to;
    uint count;
};

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index < count) {
        to.at[index] = from.at[index] * (kNegate ? -kFactor : kFactor);
    }
}
