// SPDX-License-Identifier: Apache-2.0
// Kernels that run on lists, and how lists are made.
#ifndef FIELDCAST_SHARED_LISTS_H
#define FIELDCAST_SHARED_LISTS_H
#include "types.h"

SHARED_BEGIN

// Kernels over lists: invocations per group, and groups in x before the list goes on in y.
const uint kLinearGroup = 64;
const uint kLinearGroupsX = 32768;

// Side of the groups of kernels over tiles (lib/pages.glsl), so that rays of a group start side by side.
const uint kTileSide = 8;

// A list of groups of pixels, for kernels that run on these only: how many there are, the group counts of an indirect
// dispatch, and which.
const uint kGroupListCount = 0;
const uint kGroupListDispatch = 1;
const uint kGroupListFirst = 4;

// list_groups.comp: groups whose flag is set, and if they are of kLinearGroup pixels those that touch one of them, in any
// order.
struct ListGroupsParams {
    UintBuffer flags;
    UintBuffer list;  // out
    uint width;       // pixels above and below each other are that far apart; 0: a group touches no other
    uint group_count;
};

// finish_list.comp: group counts of an indirect dispatch from a list's length.
struct FinishListParams {
    UintBuffer counters;
    uint list;                   // kCounter… of its length
    uint group_size;             // elements per group
};

SHARED_END
#endif
