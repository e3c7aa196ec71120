#version 460
// SPDX-License-Identifier: Apache-2.0
// Exposure, tone map and sRGB encoding; four pixels become three words of packed RGB8.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "lib/linear_index.glsl"
#include "lib/packing.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { ToneMapParams params; };

// K. Narkowicz. ACES Filmic Tone Mapping Curve. 2016 (fit of the ACES reference transform).
vec3 aces(vec3 c) {
    return clamp((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0);
}

vec3 srgb_oetf(vec3 c) {
    vec3 curved = 1.055 * pow(max(c, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

uint encode_pixel(uint pixel) {
    vec3 c = unpack_half3(params.radiance.at[pixel]) * params.exposure;
    c = (params.flags & kFlagAces) != 0u ? aces(c) : clamp(c, 0.0, 1.0);
    uvec3 bytes = uvec3(srgb_oetf(c) * 255.0 + 0.5);
    return bytes.r | (bytes.g << 8) | (bytes.b << 16);
}

void main() {
    uint quad = linear_index();
    if (quad * 4u >= params.pixel_count) {
        return;
    }
    uint a = encode_pixel(quad * 4u);
    uint b = encode_pixel(quad * 4u + 1u);
    uint c = encode_pixel(quad * 4u + 2u);
    uint d = encode_pixel(quad * 4u + 3u);
    params.rgb8.at[quad * 3u] = a | (b << 24);
    params.rgb8.at[quad * 3u + 1u] = (b >> 8) | (c << 16);
    params.rgb8.at[quad * 3u + 2u] = (c >> 16) | (d << 8);
}
