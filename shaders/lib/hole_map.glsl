// SPDX-License-Identifier: Apache-2.0
// Addressing of the map of holes (shared/holes.h).
#ifndef FIELDCAST_LIB_HOLE_MAP
#define FIELDCAST_LIB_HOLE_MAP
#include "shared/holes.h"
#include "shared/scene.h"

uvec2 hole_tiles(uint width, uint height) {
    return uvec2((width + kHoleTileWidth - 1u) / kHoleTileWidth, (height + kHoleTileHeight - 1u) / kHoleTileHeight);
}

// A pixel's place in the map.
struct HoleBit {
    uint word;
    uint mask;
};

HoleBit hole_bit(uint view, uvec2 at, uint width, uint height) {
    uvec2 tiles = hole_tiles(width, height);
    uvec2 tile = at / uvec2(kHoleTileWidth, kHoleTileHeight);
    uint bit = (at.y % kHoleTileHeight) * kHoleTileWidth + at.x % kHoleTileWidth;
    return HoleBit((view * tiles.y + tile.y) * tiles.x + tile.x, 1u << bit);
}

// Number of a pixel among the holes, or kNoIndex.
uint hole_number(HoleFrame frame, uint view, ivec2 at, uint width, uint height) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(width, height)))) {
        return kNoIndex;
    }
    HoleBit bit = hole_bit(view, uvec2(at), width, height);
    uint word = frame.words.at[bit.word];
    return (word & bit.mask) == 0u ? kNoIndex : frame.first.at[bit.word] + uint(bitCount(word & (bit.mask - 1u)));
}

#endif
