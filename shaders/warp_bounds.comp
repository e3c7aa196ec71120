#version 460
// SPDX-License-Identifier: Apache-2.0
// Least and most inverse depth of every block of every image, so that a search can pass over blocks.
#extension GL_GOOGLE_include_directive : require
#include "shared/warp.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { WarpBoundsParams params; };

const vec2 kNothing = vec2(1e30, -1e30);

uvec2 block_count(WarpImage image, uint side) {
    return (uvec2(image.width, image.height) + side - 1u) / side;
}

vec2 joined(vec2 a, vec2 b) {
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

// One texel around the block counts too: searches interpolate.
vec2 bounds_of_texels(WarpImage image, uvec2 block) {
    ivec2 first = max(ivec2(block * kWarpBlock) - 1, ivec2(0));
    ivec2 end = min(ivec2((block + 1u) * kWarpBlock) + 1, ivec2(image.width, image.height));
    vec2 bounds = kNothing;
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            float depth = uintBitsToFloat(params.texels.at[image.first_texel + y * image.width + x].x);
            bounds = depth < 0.0 ? bounds : joined(bounds, vec2(depth));
        }
    }
    return bounds;
}

vec2 bounds_of_blocks(WarpImage image, uvec2 coarse_block) {
    const uint kRatio = kWarpCoarseBlock / kWarpBlock;
    uvec2 count = block_count(image, kWarpBlock);
    uvec2 end = min((coarse_block + 1u) * kRatio, count);
    vec2 bounds = kNothing;
    for (uint y = coarse_block.y * kRatio; y < end.y; ++y) {
        for (uint x = coarse_block.x * kRatio; x < end.x; ++x) {
            bounds = joined(bounds, params.blocks.at[image.first_block + y * count.x + x]);
        }
    }
    return bounds;
}

void main() {
    bool is_coarse = params.is_coarse != 0u;
    WarpImage image = params.images.at[gl_GlobalInvocationID.z];
    uvec2 count = block_count(image, is_coarse ? kWarpCoarseBlock : kWarpBlock);
    uvec2 block = gl_GlobalInvocationID.xy;
    if (block.x >= count.x || block.y >= count.y) {
        return;
    }
    if (is_coarse) {
        params.coarse.at[image.first_coarse + block.y * count.x + block.x] = bounds_of_blocks(image, block);
    } else {
        params.blocks.at[image.first_block + block.y * count.x + block.x] = bounds_of_texels(image, block);
    }
}
