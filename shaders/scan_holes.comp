#version 460
// SPDX-License-Identifier: Apache-2.0
// Turns the blocks' counts into the number of each block's first hole, in one group: every invocation sums a run of
// blocks, the sums are scanned, and a second pass over the runs writes the numbers.
#extension GL_GOOGLE_include_directive : require
#include "shared/holes.h"

const uint kRuns = 256;
layout(local_size_x = kRuns) in;
layout(push_constant, scalar) uniform Push { HoleMapParams params; };

shared uint sums_[kRuns];

void main() {
    uint run = gl_LocalInvocationID.x;
    uint length = (params.block_count + kRuns - 1u) / kRuns;
    uint begin = min(run * length, params.block_count);
    uint end = min(begin + length, params.block_count);
    uint sum = 0u;
    for (uint block = begin; block < end; ++block) {
        sum += params.blocks.at[block];
    }
    sums_[run] = sum;
    barrier();
    for (uint distance = 1u; distance < kRuns; distance *= 2u) {
        uint before = run >= distance ? sums_[run - distance] : 0u;
        barrier();
        sums_[run] += before;
        barrier();
    }
    uint next = sums_[run] - sum;
    for (uint block = begin; block < end; ++block) {
        uint count = params.blocks.at[block];
        params.blocks.at[block] = next;
        next += count;
    }
    if (run == kRuns - 1u) {
        params.counters.at[kCounterHoles] = sums_[run];
    }
}
