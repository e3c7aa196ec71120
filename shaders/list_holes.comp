#version 460
// SPDX-License-Identifier: Apache-2.0
// Numbers the holes: the first number of every word, and the pixel of every number.
#extension GL_GOOGLE_include_directive : require
#include "lib/hole_map.glsl"
#include "lib/linear_index.glsl"
#include "lib/views.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { HoleMapParams params; };

uint pixel_of(uint word, uint bit) {
    uvec2 tiles = hole_tiles(params.width, params.height);
    uint row = word / tiles.x;
    uint view = row / tiles.y;
    uint x = (word - row * tiles.x) * kHoleTileWidth + bit % kHoleTileWidth;
    uint y = (row - view * tiles.y) * kHoleTileHeight + bit / kHoleTileWidth;
    return view * view_stride(params.width, params.height) + y * params.width + x;
}

void main() {
    uint block = linear_index();
    if (block >= params.block_count) {
        return;
    }
    uint number = params.blocks.at[block];
    uint end = min((block + 1u) * kHoleBlock, params.word_count);
    for (uint word = block * kHoleBlock; word < end; ++word) {
        params.first.at[word] = number;
        for (uint left = params.words.at[word]; left != 0u; left &= left - 1u) {
            params.pixels.at[number++] = pixel_of(word, uint(findLSB(left)));
        }
    }
}
