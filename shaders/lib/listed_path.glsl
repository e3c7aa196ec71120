// SPDX-License-Identifier: Apache-2.0
// Radiance of one listed pixel of a batch of views, path traced with its own samples.
#ifndef FIELDCAST_LIB_LISTED_PATH
#define FIELDCAST_LIB_LISTED_PATH
#include "lib/camera.glsl"
#include "lib/path.glsl"
#include "lib/views.glsl"

// Seed of a pixel: never a position in a compacted list.
uint pixel_seed(uint view_seed, uint x, uint y) {
    return hash_combine(view_seed, x | (y << 16));
}

Surface visible_surface(CameraRecord camera, vec2 position, Visibility seen, out vec3 direction, out float cone_width) {
    direction = camera_direction(camera, position);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(triangle, camera.origin, direction);
    cone_width = at.z / camera.focal_px;
    direction = normalize(direction);
    return make_surface(triangle, at.xy, direction, cone_width);
}

vec3 trace_radiance(TraceListParams params, Surface s, vec3 direction, float cone_width, float cone_spread, uint seed) {
    SceneInfo info = load_scene_info();
    PathSettings settings = PathSettings(params.max_bounces, (params.flags & kFlagNextEventEstimation) != 0u,
                                         params.max_indirect);
    Illumination sum = Illumination(vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < params.samples_per_pixel; ++i) {
        Sampler rng = make_sampler(seed, i);
        Illumination one = trace_path(info, settings, s, direction, cone_width, cone_spread, rng);
        if (is_finite(one.diffuse + one.specular)) {
            sum.diffuse += one.diffuse;
            sum.specular += one.specular;
        } else {
            atomicAdd(params.counters.at[kCounterInvalidSamples], 1u);
        }
    }
    float scale = 1.0 / float(params.samples_per_pixel);
    Bsdf b = make_bsdf(s, direction);
    return s.emission + (sum.diffuse * b.diffuse_modulation + sum.specular * b.specular_modulation) * scale;
}

#endif
