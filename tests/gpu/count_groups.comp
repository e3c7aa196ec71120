// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push {
    UintBuffer counter;
};

void main() {
    atomicAdd(counter.at[0], 1u + 100u * gl_WorkGroupID.y);
}
