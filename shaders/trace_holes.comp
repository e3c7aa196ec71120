#version 460
// SPDX-License-Identifier: Apache-2.0
// Path traces the pixels that no source pixel could be reused for: one compacted list over all views.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"
#include "lib/listed_path.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { TraceListParams params; };

void main() {
    uint item = linear_index();
    if (item >= params.counters.at[kCounterHoles]) {
        return;
    }
    uint index = params.list.at[item];
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    CameraRecord camera = params.cameras.at[pixel.view + 1u];
    vec3 direction;
    float cone_width;
    Surface s = visible_surface(camera, vec2(pixel.x, pixel.y) + 0.5, params.visibility.at[index], direction, cone_width);
    uint seed = pixel_seed(params.views.at[pixel.view].seed, pixel.x, pixel.y);
    vec3 radiance = trace_radiance(params, s, direction, cone_width, 1.0 / camera.focal_px, seed);
    params.radiance.at[index] = pack_half3(radiance);
}
