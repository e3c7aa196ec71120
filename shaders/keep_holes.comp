#version 460
// SPDX-License-Identifier: Apache-2.0
// Copies the illumination of holes to the pages that filters of views read, beside the reprojected illumination.
#extension GL_GOOGLE_include_directive : require
#include "shared/holes.h"
#include "lib/hole_light.glsl"
#include "lib/linear_index.glsl"
#include "lib/views.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { KeepHolesParams params; };

void main() {
    uint number = linear_index();
    if (number >= params.hole_count) {
        return;
    }
    ViewPixel pixel = locate_pixel(params.frame.pixels.at[number], params.width, params.height);
    uint texel = (pixel.view * params.height + pixel.y) * params.width + pixel.x;
    HoleLight light = unpack_hole_light(params.light_in.at[number]);
    params.diffuse.at[texel] = vec4(light.diffuse, 0.0);
    params.specular.at[texel] = vec4(light.specular, 0.0);
}
