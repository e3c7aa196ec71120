// SPDX-License-Identifier: Apache-2.0
// Lists for kernels that run on selected elements only.
#ifndef FIELDCAST_SHARED_LISTS_H
#define FIELDCAST_SHARED_LISTS_H
#include "types.h"

SHARED_BEGIN

// Kernels over lists: invocations per group, and groups in x before the list goes on in y.
const uint kLinearGroup = 64;
const uint kLinearGroupsX = 32768;

// Side of the groups of kernels over tiles (lib/pages.glsl), so that rays of a group start side by side.
const uint kTileSide = 8;

// A list of groups of pixels, for kernels that run on these only. It holds the number of groups, the group counts of an
// indirect dispatch, and the groups.
const uint kGroupListCount = 0;
const uint kGroupListDispatch = 1;
const uint kGroupListFirst = 4;

// list_groups.comp: lists the groups whose flag is set, in any order. Of groups of kLinearGroup pixels, it also lists
// those that touch one of them.
struct ListGroupsParams {
    UintBuffer flags;
    UintBuffer list;  // out
    uint width;       // distance of pixels above and below each other; 0: a group touches no other
    uint group_count;
};

// finish_list.comp: computes the group counts of an indirect dispatch from a list's length.
struct FinishListParams {
    UintBuffer counters;
    uint list;                   // kCounter… of its length
    uint group_size;             // elements per group
};

SHARED_END
#endif
