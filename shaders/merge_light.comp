#version 460
// SPDX-License-Identifier: Apache-2.0
// Merges diffuse and specular illumination of the sources, every page, into one: the light that, used as both, makes
// the materials look the same.
#extension GL_GOOGLE_include_directive : require
#include "lib/bsdf.glsl"
#include "lib/camera.glsl"
#include "lib/linear_index.glsl"
#include "lib/packing.glsl"
#include "lib/pages.glsl"
#include "lib/visible_surface.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { MergeLightParams params; };

void main() {
    uint index = linear_index();
    if (index >= params.width * params.height * params.page_count) {
        return;
    }
    PagePixel at = locate_page_pixel(index, params.width, params.height);
    Visibility seen = page_visibility(params.visibility, params.layers, at.page, params.source_count,
                                      view_stride(params.width, params.height), at.pixel);
    vec3 diffuse = unpack_r11g11b10(params.diffuse.at[index]);
    if (seen.instance == kNoInstance) {
        params.light.at[index] = pack_r11g11b10(diffuse);
        return;
    }
    CameraRecord camera = params.cameras.at[source_of_page(at.page, params.source_count)];
    vec3 direction;
    float cone_width;
    Surface s = visible_surface(camera, vec2(at.x, at.y) + 0.5, seen, direction, cone_width);
    Bsdf b = make_bsdf(s, direction);
    vec3 specular = unpack_r11g11b10(params.specular.at[index]);
    vec3 shown = diffuse * b.diffuse_modulation + specular * b.specular_modulation;
    params.light.at[index] = pack_r11g11b10(shown / (b.diffuse_modulation + b.specular_modulation)); // never 0
}
