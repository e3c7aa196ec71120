// SPDX-License-Identifier: Apache-2.0
// Indices of kernels over long lists: devices allow only 65535 groups per dimension, so longer lists go on in y.
#ifndef FIELDCAST_LIB_LINEAR_INDEX
#define FIELDCAST_LIB_LINEAR_INDEX
#include "shared/frame.h"

// Index of this invocation; the kernel's local size is kLinearGroup × 1 × 1. May lie beyond the list's end.
uint linear_index() {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kLinearGroup + gl_LocalInvocationID.x;
}

// The group of a list that this invocation belongs to; 0xFFFFFFFF beyond its end.
uint listed_group(UintBuffer list) {
    uint at = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return at < list.at[kGroupListCount] ? list.at[kGroupListFirst + at] : 0xFFFFFFFFu;
}

// Like linear_index() for a kernel that runs on the groups of a list.
uint listed_index(UintBuffer list) {
    uint group = listed_group(list);
    return group != 0xFFFFFFFFu ? group * kLinearGroup + gl_LocalInvocationID.x : group;
}

#endif
