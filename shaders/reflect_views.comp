#version 460
// SPDX-License-Identifier: Apache-2.0
// For each listed pixel of a smooth surface, one ray finds the surface that it mirrors. Mirrors show that surface with
// its light in the sources; on other glossy surfaces the ray's length says where the sources show the same reflection.
// Virtual points: T. Stachowiak. Stochastic Screen-Space Reflections. SIGGRAPH courses 2015; D. Zhdanov. ReBLUR. Ray
// Tracing Gems II, 2021. Differs: between views, not frames; the length is the target's own.
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

// A smooth surface as a view's pixel sees it.
struct SmoothPixel {
    Surface surface;
    Visibility seen;
    WorldTriangle triangle;
    vec3 direction; // of the camera's ray, unit length
    float depth;
    float footprint; // of the pixel, metres
    float pixel_angle;
};

SmoothPixel find_pixel(uint index, ViewPixel pixel) {
    CameraRecord camera = params.cameras.at[kMaxSources + pixel.view];
    SmoothPixel found;
    found.seen = params.visibility.at[index];
    vec3 direction = camera_direction(camera, vec2(pixel.x, pixel.y) + 0.5);
    found.triangle = load_world_triangle(found.seen.instance, found.seen.primitive);
    vec3 at = intersect_plane(found.triangle, camera.origin, direction);
    found.depth = at.z;
    found.footprint = at.z / camera.focal_px;
    found.pixel_angle = 1.0 / camera.focal_px;
    found.direction = normalize(direction);
    found.surface = make_surface(found.triangle, at.xy, found.direction, found.footprint);
    return found;
}

// Radiance that arrives from the ray's hit; false if neither the sources nor the scene's lights alone determine it.
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

// Specular light from the sources that show the reflection. The more a source's view of it resembles the viewer's, the
// more of `specular` stays.
vec3 specular_in_sources(SmoothPixel p, float curvature, float distance_m, vec3 specular) {
    vec3 image;
    if (!virtual_image(p.surface, curvature, p.direction, distance_m, image)) {
        return specular;
    }
    Target target = make_target(p.surface, p.seen.instance, p.direction, p.footprint, p.depth);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < params.settings.source_count; ++i) {
        CameraRecord source = params.cameras.at[i];
        vec3 found;
        if (gather_virtual_image(source, i, image, target, p.surface.roughness, found)) {
            bool is_alone = params.settings.source_count == 1u;
            float weight = is_alone ? 1.0 : specular_confidence(p.surface, -p.direction, source);
            sum += weight * vec4(mix(specular, found, lobe_turn(p.surface, -p.direction, source)), 1.0);
        }
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : specular;
}

// Specular light from the direction that the pixel mirrors; `reprojected` is the surface's own light in the sources.
vec3 mirrored_light(SmoothPixel p, vec3 mirrored, uint seed, vec3 reprojected) {
    Hit hit = trace_closest(path_origin(p.surface, mirrored), mirrored, 0.0, 1e30, kTraceStochastic, seed);
    float distance_m = hit.instance == kNoInstance ? kFar : hit.t;
    float curvature = mean_curvature(p.triangle, p.surface);
    float cone_width = p.footprint + distance_m * (p.pixel_angle + 2.0 * abs(curvature) * p.footprint);
    vec3 specular;
    if (p.surface.roughness <= kMirrorRoughness && known_radiance(hit, mirrored, cone_width, specular)) {
        return specular;
    }
    return specular_in_sources(p, curvature, distance_m, reprojected);
}

void main() {
    uint item = linear_index();
    if (item >= params.counters.at[kCounterReflections]) {
        return;
    }
    uint index = params.list.at[item];
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    SmoothPixel p = find_pixel(index, pixel);
    Surface s = p.surface;
    vec3 mirrored = reflect(p.direction, s.normal);
    Reused light = gather_sources(params.cameras, 0u, s, p.seen.instance, p.direction, p.footprint, p.depth);
    if (!light.found || dot(mirrored, s.geometric_normal) <= 0.0) {
        return;
    }
    uint seed = hash_combine(params.views.at[pixel.view].seed, index);
    vec3 specular = mirrored_light(p, mirrored, seed, light.specular);
    Bsdf b = make_bsdf(s, p.direction);
    vec3 radiance = s.emission + light.diffuse * b.diffuse_modulation + specular * b.specular_modulation;
    params.radiance.at[index] = pack_half3(radiance);
}
