// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    UintBuffer values;
    uint count;
    uint offset;
};

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index < count) {
        values.at[index] += offset;
    }
}
