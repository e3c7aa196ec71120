#version 460
// SPDX-License-Identifier: Apache-2.0
// BLEND surfaces in front of what a pixel sees, composited over it exactly per view. Their illumination is reprojected
// from the source's layer pages; what those do not show is path traced.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"
#include "lib/listed_path.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { TraceListParams params; };

#include "lib/reprojection.glsl"

// Light that a layer's surface sends to the viewer, from the source; false: not to be had there.
bool reproject_layer(Surface s, uint instance, vec3 direction, float footprint, out vec3 radiance) {
    CameraRecord source = params.cameras.at[0];
    vec3 p = camera_project(source, s.position);
    Target target = make_target(s, instance, direction, max(footprint, p.z / source.focal_px), p.z);
    Gathered sum = Gathered(vec3(0.0), vec3(0.0), 0.0, kDiscardId);
    for (uint page = 1u; p.z > 0.0 && sum.weight == 0.0 && page < params.page_count; ++page) {
        sum = gather_around(source, page, p.xy, target);
    }
    Bsdf b = make_bsdf(s, direction);
    radiance = s.emission + (sum.diffuse * b.diffuse_modulation + sum.specular * b.specular_modulation) /
                                max(sum.weight, 1e-6);
    return sum.weight > 0.0;
}

vec3 composite(vec3 behind, uint layer, Visibility seen, CameraRecord camera, vec2 position, uint seed) {
    vec3 direction;
    float cone_width;
    Surface s = visible_surface(camera, position, seen, direction, cone_width);
    vec3 own;
    if (!reproject_layer(s, seen.instance, direction, cone_width, own)) {
        own = trace_radiance(params, s, direction, cone_width, 1.0 / camera.focal_px, hash_combine(seed, layer + 1u));
        atomicAdd(params.counters.at[kCounterLayerPaths], 1u);
    }
    return mix(behind, own, clamp(s.alpha, 0.0, 1.0));
}

void main() {
    uint item = linear_index();
    if (item >= params.counters.at[kCounterLayers]) {
        return;
    }
    uint index = params.list.at[item];
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    CameraRecord camera = params.cameras.at[pixel.view + 1u];
    uint seed = pixel_seed(params.views.at[pixel.view].seed, pixel.x, pixel.y);
    vec3 radiance = unpack_half3(params.radiance.at[index]);
    for (uint layer = kMaxLayers; layer-- > 0u;) { // farthest first
        Visibility seen = params.layers.at[index * kMaxLayers + layer];
        if (seen.instance != kNoInstance) {
            radiance = composite(radiance, layer, seen, camera, vec2(pixel.x, pixel.y) + 0.5, seed);
        }
    }
    params.radiance.at[index] = pack_half3(radiance);
}
