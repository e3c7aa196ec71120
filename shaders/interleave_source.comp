#version 460
// SPDX-License-Identifier: Apache-2.0
// Wire planes into the texels that reproject.comp fetches: two fetches per tap instead of six.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "lib/linear_index.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { InterleaveParams params; };

void main() {
    uint pixel = linear_index();
    if (pixel < params.pixel_count) {
        params.geometry.at[pixel] = uvec4(floatBitsToUint(params.depth.at[pixel]), params.normal.at[pixel],
                                          params.id.at[pixel], params.material.at[pixel]);
        params.illumination.at[pixel] = uvec2(params.diffuse.at[pixel], params.specular.at[pixel]);
    }
}
