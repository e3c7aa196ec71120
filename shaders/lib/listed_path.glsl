// SPDX-License-Identifier: Apache-2.0
// Radiance of one listed pixel of a batch of views, path traced with its own samples.
#ifndef FIELDCAST_LIB_LISTED_PATH
#define FIELDCAST_LIB_LISTED_PATH
#include "lib/camera.glsl"
#include "lib/path.glsl"
#include "lib/views.glsl"
#include "lib/visible_surface.glsl"

// Seed of a pixel. It never depends on a position in a compacted list.
uint pixel_seed(uint view_seed, uint x, uint y) {
    return hash_combine(view_seed, x | (y << 16));
}

// Mean illumination of a surface over `samples` paths. `counters`: kCounterInvalidSamples.
Illumination trace_illumination(PathSettings settings, uint samples, UintBuffer counters, Surface s, vec3 direction,
                                float cone_width, float cone_spread, uint seed) {
    SceneInfo info = load_scene_info();
    Illumination sum = kNoIllumination;
    for (uint i = 0u; i < samples; ++i) {
        Sampler rng = make_sampler(seed, i);
        Illumination one = trace_path(info, settings, s, direction, cone_width, cone_spread, rng);
        if (is_finite(one.diffuse + one.specular + one.punctual)) {
            sum.diffuse += one.diffuse + one.punctual;
            sum.specular += one.specular;
        } else {
            atomicAdd(counters.at[kCounterInvalidSamples], 1u);
        }
    }
    float scale = 1.0 / float(samples);
    return Illumination(sum.diffuse * scale, sum.specular * scale, vec3(0.0));
}

vec3 trace_radiance(TraceListParams params, Surface s, vec3 direction, float cone_width, float cone_spread, uint seed) {
    PathSettings settings = make_path_settings(params.path, params.max_indirect);
    Illumination light = trace_illumination(settings, params.samples_per_pixel, params.counters, s, direction, cone_width,
                                            cone_spread, seed);
    Bsdf b = make_bsdf(s, direction);
    return s.emission + light.diffuse * b.diffuse_modulation + light.specular * b.specular_modulation;
}

#endif
