#version 460
// SPDX-License-Identifier: Apache-2.0
// Illumination into wire precision: views are made from this, never from something finer.
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "lib/linear_index.glsl"
#include "lib/packing.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { PackParams params; };

void main() {
    uint item = linear_index();
    if (item < params.pixel_count) {
        uint pixel = params.first_pixel + item;
        vec3 diffuse = vec3(0.0);
        vec3 specular = vec3(0.0);
        if (params.id.at[pixel] != 0xFFFFFFFFu) { // elsewhere, filters may have left old values
            diffuse = params.diffuse_in.at[pixel].rgb;
            if (params.is_punctual_apart != 0u) {
                diffuse += params.punctual_in.at[pixel].rgb;
            }
            specular = params.specular_in.at[pixel].rgb;
        }
        params.diffuse.at[pixel] = pack_r11g11b10(diffuse);
        params.specular.at[pixel] = pack_r11g11b10(specular);
    }
}
