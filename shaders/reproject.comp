#version 460
// SPDX-License-Identifier: Apache-2.0
// Reprojects the sources' illumination into every pixel of every view and remodulates it with the view's own material,
// or keeps it for filters. Pixels without light to reuse become holes. Sky and emission are exact.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/geometry_texel.glsl"
#include "lib/hole_map.glsl"
#include "lib/lights.glsl"
#include "lib/views.glsl"

layout(local_size_x = 64) in;
layout(constant_id = kSpecialiseBlend) const bool kHasBlend = false;
layout(push_constant, scalar) uniform Push { ReprojectParams params; };

#include "lib/reflection.glsl"
#include "lib/reprojection.glsl"

void discard_pixel(uint view, uvec2 at, uint reason) {
    atomicAdd(params.counters.at[kCounterDiscards + view * 4u + reason], 1u);
    HoleBit bit = hole_bit(view, at, params.width, params.height);
    atomicOr(params.holes.at[bit.word], bit.mask);
}

// Pixels whose specular light reflect_views.comp looks up anew.
void list_if_glossy(uint pixel, Surface s, Bsdf b, vec3 direction) {
    bool listed = false;
    for (uint i = 0u; i < params.settings.source_count; ++i) {
        listed = listed || is_glossy(s, b, -direction, params.cameras.at[i]);
    }
    if (listed) {
        params.glossy_pixels.at[atomicAdd(params.counters.at[kCounterReflections], 1u)] = pixel;
    }
}

void keep_light(uint texel, uvec4 geometry, vec3 diffuse, vec3 specular) {
    params.light.geometry.at[texel] = geometry;
    params.light.diffuse.at[texel] = vec4(diffuse, 0.0);
    params.light.specular.at[texel] = vec4(specular, 0.0);
}

// A pixel that sees a surface.
void reproject(uint view, Visibility seen, CameraRecord camera, uvec2 at_pixel, uint pixel, uint texel) {
    vec3 direction = camera_direction(camera, vec2(at_pixel) + 0.5);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(triangle, camera.origin, direction);
    direction = normalize(direction);
    Surface s = make_surface(triangle, at.xy, direction, at.z / camera.focal_px);
    Reused light = gather_sources(params.cameras, 0u, s, seen.instance, direction, at.z / camera.focal_px, at.z);
    if (!light.found) {
        discard_pixel(view, at_pixel, light.reason);
    }
    if ((params.flags & kFlagKeepLight) != 0u) {
        keep_light(texel, geometry_texel(s, seen.instance, at.z), light.diffuse, light.specular);
    } else if (light.found) {
        Bsdf b = make_bsdf(s, direction);
        vec3 radiance = s.emission + light.diffuse * b.diffuse_modulation + light.specular * b.specular_modulation;
        params.radiance.at[pixel] = pack_half3(radiance);
        if ((params.flags & kFlagReflections) != 0u) {
            list_if_glossy(pixel, s, b, direction);
        }
    }
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= params.width) {
        return;
    }
    uint pixel = id.z * view_stride(params.width, params.height) + id.y * params.width + id.x;
    uint texel = (id.z * params.height + id.y) * params.width + id.x;
    CameraRecord camera = params.cameras.at[kMaxSources + id.z];
    Visibility seen = params.visibility.at[pixel];
    if (seen.instance == kNoInstance) {
        vec3 direction = normalize(camera_direction(camera, vec2(id.xy) + 0.5));
        params.radiance.at[pixel] = pack_half3(environment_radiance(load_scene_info(), direction));
        if ((params.flags & kFlagKeepLight) != 0u) {
            keep_light(texel, kNoSurface, vec3(0.0), vec3(0.0));
        }
    } else {
        reproject(id.z, seen, camera, id.xy, pixel, texel);
    }
    if (kHasBlend && params.layers.at[pixel * 2u].instance != kNoInstance) {
        uint slot = atomicAdd(params.counters.at[kCounterLayers], 1u);
        params.layer_pixels.at[slot] = pixel;
    }
}
