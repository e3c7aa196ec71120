#version 460
// SPDX-License-Identifier: Apache-2.0
// Unpacks colour and inverse depth from the wire into the texels that warp_views.comp searches.
#extension GL_GOOGLE_include_directive : require
#include "shared/warp.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { WarpUnpackParams params; };

const uint kTile = 8u;      // kResidualTile
const uint kColumns = 128u; // kResidualColumns
const uint kNowhere = 0xFFFFFFFFu;

// The texel that pixel `at` of the planes belongs to.
uint texel_of(uvec2 at) {
    if (params.tile_count == 0u) {
        return params.images.at[0].first_texel + at.y * params.width + at.x;
    }
    uint slot = (at.y / kTile) * kColumns + at.x / kTile;
    if (slot >= params.tile_count) {
        return kNowhere;
    }
    uint tile = params.tiles.at[slot];
    WarpImage first = params.images.at[1];
    uvec2 tiles = (uvec2(first.width, first.height) + kTile - 1u) / kTile;
    uint view = tile / (tiles.x * tiles.y);
    uint inside = tile - view * tiles.x * tiles.y;
    uvec2 pixel = uvec2(inside % tiles.x, inside / tiles.x) * kTile + at % kTile;
    bool is_in_view = pixel.x < first.width && pixel.y < first.height;
    return is_in_view ? params.images.at[1u + view].first_texel + pixel.y * first.width + pixel.x : kNowhere;
}

uint read_byte(uint at) {
    return (params.colour.at[at / 4u] >> (at % 4u * 8u)) & 0xFFu;
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= params.width || at.y >= params.height) {
        return;
    }
    uint texel = texel_of(at);
    if (texel == kNowhere) {
        return;
    }
    uint pixel = at.y * params.width + at.x;
    uint steps = (params.inverse_depth.at[pixel / 2u] >> (pixel % 2u * 16u)) & 0xFFFFu;
    uint colour = read_byte(3u * pixel) | (read_byte(3u * pixel + 1u) << 8) | (read_byte(3u * pixel + 2u) << 16);
    params.texels.at[texel] = uvec2(floatBitsToUint(float(steps) * params.unit), colour);
}
