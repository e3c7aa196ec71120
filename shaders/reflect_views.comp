#version 460
// SPDX-License-Identifier: Apache-2.0
// Listed pixels of smooth surfaces: one ray finds what they mirror. Mirrors show it as the sources know it; on other glossy
// surfaces the ray's length says where the sources show the same reflection.
// Virtual points: T. Stachowiak. Stochastic Screen-Space Reflections. SIGGRAPH courses 2015; D. Zhdanov. ReBLUR. Ray Tracing
// Gems II, 2021. Differs: between views, not frames; the length is the target's own.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/lights.glsl"
#include "lib/linear_index.glsl"
#include "lib/ray_origin.glsl"
#include "lib/traversal.glsl"
#include "lib/views.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { TraceListParams params; };

#include "lib/reflection.glsl"
#include "lib/source_light.glsl"

const float kFar = 1e6; // metres to the environment

// Radiance that arrives from what a ray met, if the sources or the scene's lights alone say what that is.
bool known_radiance(Hit hit, vec3 direction, float cone_width, out vec3 radiance) {
    if (hit.instance == kNoInstance) {
        radiance = environment_radiance(load_scene_info(), direction);
        return true;
    }
    WorldTriangle triangle = load_world_triangle(hit.instance, hit.primitive);
    Surface s = make_surface(triangle, hit.barycentrics, direction, cone_width);
    vec3 reflected;
    bool known = light_in_source(params.cameras, s, hit.instance, make_bsdf(s, direction), reflected);
    radiance = s.emission + reflected;
    return known;
}

// Specular light from the sources that show the reflection; as much of `specular` stays as their view of it resembles the
// viewer's.
vec3 specular_in_sources(Surface s, uint instance, float curvature, vec3 direction, float distance_m, float footprint,
                         float depth, vec3 specular) {
    vec3 image;
    if (!virtual_image(s, curvature, direction, distance_m, image)) {
        return specular;
    }
    Target target = make_target(s, instance, direction, footprint, depth);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < params.settings.source_count; ++i) {
        CameraRecord source = params.cameras.at[i];
        vec3 found;
        if (gather_virtual_image(source, i, image, target, s.roughness, found)) {
            float weight = params.settings.source_count == 1u ? 1.0 : specular_confidence(s, -direction, source);
            sum += weight * vec4(mix(specular, found, lobe_turn(s, -direction, source)), 1.0);
        }
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : specular;
}

void main() {
    uint item = linear_index();
    if (item >= params.counters.at[kCounterReflections]) {
        return;
    }
    uint index = params.list.at[item];
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    CameraRecord camera = params.cameras.at[kMaxSources + pixel.view];
    Visibility seen = params.visibility.at[index];
    vec3 direction = camera_direction(camera, vec2(pixel.x, pixel.y) + 0.5);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(triangle, camera.origin, direction);
    float footprint = at.z / camera.focal_px;
    direction = normalize(direction);
    Surface s = make_surface(triangle, at.xy, direction, footprint);
    vec3 mirrored = reflect(direction, s.normal);
    Reused light = gather_sources(params.cameras, 0u, s, seen.instance, direction, footprint, at.z);
    if (!light.found || dot(mirrored, s.geometric_normal) <= 0.0) {
        return;
    }
    uint seed = hash_combine(params.views.at[pixel.view].seed, index);
    Hit hit = trace_closest(path_origin(s, mirrored), mirrored, 0.0, 1e30, kTraceStochastic, seed);
    float distance_m = hit.instance == kNoInstance ? kFar : hit.t;
    float curvature = mean_curvature(triangle, s);
    vec3 specular;
    float cone_width = footprint + distance_m * (1.0 / camera.focal_px + 2.0 * abs(curvature) * footprint);
    if (s.roughness > kMirrorRoughness || !known_radiance(hit, mirrored, cone_width, specular)) {
        specular = specular_in_sources(s, seen.instance, curvature, direction, distance_m, footprint, at.z, light.specular);
    }
    Bsdf b = make_bsdf(s, direction);
    vec3 radiance = s.emission + light.diffuse * b.diffuse_modulation + specular * b.specular_modulation;
    params.radiance.at[index] = pack_half3(radiance);
}
