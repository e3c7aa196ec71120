#version 460
// SPDX-License-Identifier: Apache-2.0
// Turns the lengths of the hole and layer lists into the group counts of their indirect dispatches.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { FinishListParams params; };

void finish(uint count_at, uint groups_at) {
    uint groups = (params.counters.at[count_at] + kLinearGroup - 1u) / kLinearGroup;
    params.counters.at[groups_at] = min(groups, kLinearGroupsX);
    params.counters.at[groups_at + 1u] = (groups + kLinearGroupsX - 1u) / kLinearGroupsX;
    params.counters.at[groups_at + 2u] = 1u;
}

void main() {
    finish(kCounterHoles, kCounterHoleGroups);
    finish(kCounterLayers, kCounterLayerGroups);
}
