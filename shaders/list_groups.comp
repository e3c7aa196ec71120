#version 460
// SPDX-License-Identifier: Apache-2.0
// Lists the groups of pixels that filters have to run on: those with a surface, and those with a pixel that touches one,
// because filters look at their neighbours' values whatever these show. In one group, like scan_holes.comp.
#extension GL_GOOGLE_include_directive : require
#include "lib/scan_runs.glsl"
#include "shared/frame.h"

layout(local_size_x = kRuns) in;
layout(push_constant, scalar) uniform Push { ListGroupsParams params; };

bool has_flag(int first_pixel, int last_pixel) {
    int group = max(first_pixel, 0) / int(kLinearGroup);
    int last = min(last_pixel / int(kLinearGroup), int(params.group_count) - 1);
    bool found = false;
    for (; last_pixel >= 0 && group <= last && !found; ++group) {
        found = params.flags.at[group] != 0u;
    }
    return found;
}

// The rows above and below may be of another page: a group too many does no harm.
bool is_wanted(uint group) {
    if (params.width == 0u) {
        return params.flags.at[group] != 0u;
    }
    int first = int(group * kLinearGroup) - 1;
    int last = first + int(kLinearGroup) + 1;
    int width = int(params.width);
    return has_flag(first, last) || has_flag(first - width, last - width) || has_flag(first + width, last + width);
}

void main() {
    uint invocation = gl_LocalInvocationID.x;
    Run run = run_of(invocation, params.group_count);
    uint sum = 0u;
    for (uint group = run.begin; group < run.end; ++group) {
        sum += is_wanted(group) ? 1u : 0u;
    }
    uint next = kGroupListFirst + scan_runs(invocation, sum);
    for (uint group = run.begin; group < run.end; ++group) {
        if (is_wanted(group)) {
            params.list.at[next++] = group;
        }
    }
    if (invocation == 0u) {
        uint count = sum_of_runs();
        params.list.at[kGroupListCount] = count;
        params.list.at[kGroupListDispatch] = min(count, kLinearGroupsX);
        params.list.at[kGroupListDispatch + 1u] = (count + kLinearGroupsX - 1u) / kLinearGroupsX;
        params.list.at[kGroupListDispatch + 2u] = 1u;
    }
}
