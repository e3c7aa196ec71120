#version 460
// SPDX-License-Identifier: Apache-2.0
// Radiance of holes from their illumination and the view's own material.
#extension GL_GOOGLE_include_directive : require
#include "shared/holes.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { HoleParams params; };

#include "lib/bsdf.glsl"
#include "lib/holes.glsl"
#include "lib/visible_surface.glsl"

void main() {
    uint number = linear_index();
    if (number >= params.hole_count) {
        return;
    }
    HoleFrame frame = params.frames.at[0];
    uint index = frame.pixels.at[number];
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    CameraRecord camera = frame.cameras.at[kMaxSources + pixel.view];
    vec3 direction;
    float cone_width;
    vec2 position = vec2(pixel.x, pixel.y) + 0.5;
    Surface s = visible_surface(camera, position, params.visibility.at[index], direction, cone_width);
    Bsdf b = make_bsdf(s, direction);
    HoleLight light = unpack_hole_light(params.light_in.at[number]);
    vec3 radiance = s.emission + light.diffuse * b.diffuse_modulation + light.specular * b.specular_modulation;
    params.radiance.at[index] = pack_half3(radiance);
}
