#version 460
// SPDX-License-Identifier: Apache-2.0
// Turns the blocks' counts into the number of each block's first hole, in one group: every invocation sums a run of
// blocks, the sums are scanned, and the runs are gone through again.
#extension GL_GOOGLE_include_directive : require
#include "lib/scan_runs.glsl"
#include "shared/holes.h"

layout(local_size_x = kRuns) in;
layout(push_constant, scalar) uniform Push { HoleMapParams params; };

void main() {
    uint invocation = gl_LocalInvocationID.x;
    Run run = run_of(invocation, params.block_count);
    uint sum = 0u;
    for (uint block = run.begin; block < run.end; ++block) {
        sum += params.blocks.at[block];
    }
    uint next = scan_runs(invocation, sum);
    for (uint block = run.begin; block < run.end; ++block) {
        uint count = params.blocks.at[block];
        params.blocks.at[block] = next;
        next += count;
    }
    if (invocation == 0u) {
        params.counters.at[kCounterHoles] = sum_of_runs();
    }
}
