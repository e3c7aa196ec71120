#version 460
// SPDX-License-Identifier: Apache-2.0
// BLEND surfaces in front of what a pixel sees: path traced and composited over it, exactly per view.
#extension GL_GOOGLE_include_directive : require
#include "lib/listed_path.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TraceListParams params; };

void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= params.counters.at[kCounterLayers]) {
        return;
    }
    uint index = params.list.at[item];
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    CameraRecord camera = params.cameras.at[pixel.view + 1u];
    uint seed = pixel_seed(params.views.at[pixel.view].seed, pixel.x, pixel.y);
    vec3 radiance = unpack_half3(params.radiance.at[index]);
    for (int layer = 1; layer >= 0; --layer) { // farther layer first
        Visibility seen = params.layers.at[index * 2u + uint(layer)];
        if (seen.instance != kNoInstance) {
            vec3 direction;
            float cone_width;
            Surface s = visible_surface(camera, vec2(pixel.x, pixel.y) + 0.5, seen, direction, cone_width);
            vec3 own = trace_radiance(params, s, direction, cone_width, 1.0 / camera.focal_px, hash_combine(seed, uint(layer) + 1u));
            radiance = mix(radiance, own, clamp(s.alpha, 0.0, 1.0));
        }
    }
    params.radiance.at[index] = pack_half3(radiance);
}
