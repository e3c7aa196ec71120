#version 460
// SPDX-License-Identifier: Apache-2.0
// Reprojects the sources' illumination into every pixel of every view and remodulates it with the view's own material.
// What cannot be reused becomes a hole. Sky and emission are exact.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/hole_map.glsl"
#include "lib/lights.glsl"
#include "lib/views.glsl"

layout(local_size_x = 64) in;
layout(constant_id = kSpecialiseBlend) const bool kHasBlend = false;
layout(push_constant, scalar) uniform Push { ReprojectParams params; };

#include "lib/reprojection.glsl"

void discard_pixel(uint view, uvec2 at, uint reason) {
    atomicAdd(params.counters.at[kCounterDiscards + view * 4u + reason], 1u);
    HoleBit bit = hole_bit(view, at, params.width, params.height);
    atomicOr(params.holes.at[bit.word], bit.mask);
}

// Radiance of a pixel that sees a surface; false: it has to be traced.
bool reproject(uint view, Visibility seen, CameraRecord camera, vec2 position, out vec3 radiance) {
    vec3 direction = camera_direction(camera, position);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(triangle, camera.origin, direction);
    direction = normalize(direction);
    Surface s = make_surface(triangle, at.xy, direction, at.z / camera.focal_px);
    Reused light = gather_sources(params.cameras, 0u, s, seen.instance, direction, at.z / camera.focal_px, at.z);
    if (!light.found) {
        discard_pixel(view, uvec2(position), light.reason);
        return false;
    }
    Bsdf b = make_bsdf(s, direction);
    radiance = s.emission + light.diffuse * b.diffuse_modulation + light.specular * b.specular_modulation;
    return true;
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= params.width) {
        return;
    }
    uint pixel = id.z * view_stride(params.width, params.height) + id.y * params.width + id.x;
    CameraRecord camera = params.cameras.at[kMaxSources + id.z];
    vec2 position = vec2(id.xy) + 0.5;
    Visibility seen = params.visibility.at[pixel];
    vec3 radiance;
    if (seen.instance == kNoInstance) {
        radiance = environment_radiance(load_scene_info(), normalize(camera_direction(camera, position)));
        params.radiance.at[pixel] = pack_half3(radiance);
    } else if (reproject(id.z, seen, camera, position, radiance)) {
        params.radiance.at[pixel] = pack_half3(radiance);
    }
    if (kHasBlend && params.layers.at[pixel * 2u].instance != kNoInstance) {
        uint slot = atomicAdd(params.counters.at[kCounterLayers], 1u);
        params.layer_pixels.at[slot] = pixel;
    }
}
