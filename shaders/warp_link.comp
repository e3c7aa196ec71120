#version 460
// SPDX-License-Identifier: Apache-2.0
// Finds the neighbouring texels that show the same surface. Inverse depth is an affine function of the position on
// every plane, so a surface continues where the neighbour's inverse depth is about the same, or where it matches the
// prediction from either side.
#extension GL_GOOGLE_include_directive : require
#include "shared/warp.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { WarpLinkParams params; };

const float kSame = 0.01;       // of the inverse depth
const float kPredicted = 0.005; // likewise
const float kSteps = 2.5;       // rounding of four values that are added with weights 1, 2, 1 is at most 2 steps

// Inverse depth at `at`; negative: nothing is known there.
float inverse_depth(WarpImage image, ivec2 at) {
    bool is_inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(image.width, image.height)));
    return is_inside ? uintBitsToFloat(params.texels.at[image.first_texel + at.y * image.width + at.x].x) : -1.0;
}

bool is_continued(WarpImage image, ivec2 at, ivec2 to_neighbour) {
    float here = inverse_depth(image, at);
    float there = inverse_depth(image, at + to_neighbour);
    if (here < 0.0 || there < 0.0) {
        return false;
    }
    float most = max(here, there);
    float jump = there - here;
    if (abs(jump) <= kSame * most) {
        return true;
    }
    float before = inverse_depth(image, at - to_neighbour);
    float after = inverse_depth(image, at + 2 * to_neighbour);
    float tolerance = kPredicted * most + kSteps * params.unit;
    return (before >= 0.0 && abs(jump - (here - before)) <= tolerance) ||
           (after >= 0.0 && abs(jump - (after - there)) <= tolerance);
}

void main() {
    WarpImage image = params.images.at[gl_GlobalInvocationID.z];
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= image.width || at.y >= image.height) {
        return;
    }
    uint links = is_continued(image, at, ivec2(1, 0)) ? kLinkRight : 0u;
    links |= is_continued(image, at, ivec2(0, 1)) ? kLinkBelow : 0u;
    links |= is_continued(image, at, ivec2(1, 1)) ? kLinkBelowRight : 0u;
    links |= is_continued(image, at, ivec2(-1, 1)) ? kLinkBelowLeft : 0u;
    uint texel = image.first_texel + at.y * image.width + at.x;
    params.texels.at[texel].y = (params.texels.at[texel].y & 0xFFFFFFu) | links;
}
