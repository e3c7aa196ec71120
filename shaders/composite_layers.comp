#version 460
// SPDX-License-Identifier: Apache-2.0
// Composites the BLEND surfaces in front of the visible surface of a pixel, exactly per view. Their illumination is
// reprojected from the sources' layer pages, or path traced where these lack it.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"
#include "lib/listed_path.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { TraceListParams params; };

#include "lib/reprojection.glsl"

// Light that a layer's surface sends to the viewer, from the sources; false: they do not show it.
bool reproject_layer(Surface s, uint instance, vec3 direction, float footprint, float depth, out vec3 radiance) {
    Reused light = Reused(vec3(0.0), vec3(0.0), false, 0u);
    for (uint layer = 1u; !light.found && layer <= params.layer_count; ++layer) {
        light = gather_sources(params.cameras, layer, s, instance, direction, footprint, depth);
    }
    Bsdf b = make_bsdf(s, direction);
    radiance = s.emission + light.diffuse * b.diffuse_modulation + light.specular * b.specular_modulation;
    return light.found;
}

vec3 composite(vec3 behind, uint layer, Visibility seen, CameraRecord camera, vec2 position, uint seed) {
    vec3 direction;
    float cone_width;
    Surface s = visible_surface(camera, position, seen, direction, cone_width);
    float depth = dot(s.position - camera.origin, camera.forward);
    vec3 own;
    if (!reproject_layer(s, seen.instance, direction, cone_width, depth, own)) {
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
    CameraRecord camera = params.cameras.at[kMaxSources + pixel.view];
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
