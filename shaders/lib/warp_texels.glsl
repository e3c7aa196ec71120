// SPDX-License-Identifier: Apache-2.0
// Texels of the images that views are made from (shared/warp.h).
#ifndef FIELDCAST_LIB_WARP_TEXELS
#define FIELDCAST_LIB_WARP_TEXELS
#include "shared/warp.h"

// Whether the texels at `a` and `b`, neighbours, show the same surface; the second words of both are given.
bool is_linked(ivec2 a, uint word_a, ivec2 b, uint word_b) {
    ivec2 d = b - a;
    bool is_ahead = d.y > 0 || (d.y == 0 && d.x > 0);
    uint word = is_ahead ? word_a : word_b;
    d = is_ahead ? d : -d;
    uint link = d.y == 0 ? kLinkRight : d.x == 0 ? kLinkBelow : d.x > 0 ? kLinkBelowRight : kLinkBelowLeft;
    return (word & link) != 0u;
}

vec3 texel_colour(uint word) {
    return vec3(word & 0xFFu, (word >> 8) & 0xFFu, (word >> 16) & 0xFFu);
}

uint pack_colour(vec3 colour) {
    uvec3 bytes = uvec3(clamp(colour + 0.5, 0.0, 255.0));
    return bytes.r | (bytes.g << 8) | (bytes.b << 16);
}

#endif
