#version 460
// SPDX-License-Identifier: Apache-2.0
// Turns the length of a list into the group counts of its indirect dispatch.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { FinishListParams params; };

void main() {
    uint groups = (params.counters.at[params.list] + params.group_size - 1u) / params.group_size;
    params.counters.at[params.list + 1u] = min(groups, kLinearGroupsX);
    params.counters.at[params.list + 2u] = (groups + kLinearGroupsX - 1u) / kLinearGroupsX;
    params.counters.at[params.list + 3u] = 1u;
}
