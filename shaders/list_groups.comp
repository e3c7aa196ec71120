#version 460
// SPDX-License-Identifier: Apache-2.0
// Lists the groups of pixels that filters have to run on: those with a surface, and those with a pixel that touches
// one, because filters read the values of neighbours with or without a surface.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"

layout(local_size_x = kLinearGroup) in;
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
    uint group = linear_index();
    if (group < params.group_count && is_wanted(group)) {
        params.list.at[kGroupListFirst + atomicAdd(params.list.at[kGroupListCount], 1u)] = group;
    }
}
