#version 460
// SPDX-License-Identifier: Apache-2.0
// Radiance of views from their averaged or filtered illumination and their own material.
#extension GL_GOOGLE_include_directive : require
#include "lib/bsdf.glsl"
#include "lib/linear_index.glsl"
#include "lib/pages.glsl"
#include "lib/visible_surface.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { ShadeViewsParams params; };

void main() {
    uint texel = linear_index();
    if (texel >= params.width * params.height * params.view_count) {
        return;
    }
    PagePixel at = locate_page_pixel(texel, params.width, params.height);
    uint pixel = at.page * view_stride(params.width, params.height) + at.pixel;
    Visibility seen = params.visibility.at[pixel];
    if (seen.instance == kNoInstance) {
        return;
    }
    vec3 direction;
    float cone_width;
    Surface s = visible_surface(params.cameras.at[at.page], vec2(at.x, at.y) + 0.5, seen, direction, cone_width);
    Bsdf b = make_bsdf(s, direction);
    vec3 diffuse = params.diffuse.at[texel].rgb * b.diffuse_modulation;
    vec3 specular = params.specular.at[texel].rgb * b.specular_modulation;
    params.radiance.at[pixel] = pack_half3(s.emission + diffuse + specular);
}
