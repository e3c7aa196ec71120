#version 460
// SPDX-License-Identifier: Apache-2.0
// Counts the holes in each block of the map's words.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"
#include "shared/holes.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { HoleMapParams params; };

void main() {
    uint block = linear_index();
    if (block >= params.block_count) {
        return;
    }
    uint end = min((block + 1u) * kHoleBlock, params.word_count);
    uint sum = 0u;
    for (uint word = block * kHoleBlock; word < end; ++word) {
        sum += uint(bitCount(params.words.at[word]));
    }
    params.blocks.at[block] = sum;
}
