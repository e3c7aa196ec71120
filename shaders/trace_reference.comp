#version 460
// SPDX-License-Identifier: Apache-2.0
// Path traces every pixel of one view from scratch, primary ray included, and adds the radiance to a film.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/path.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { TraceReferenceParams params; };

// Radiance along one primary ray; BLEND surfaces are met with the probability of their alpha.
vec3 trace_primary(SceneInfo info, CameraRecord camera, vec3 direction, float stretch, inout Sampler rng) {
    Hit hit = trace_closest(camera.origin, direction, 0.0, 1e30, kTraceStochastic, rng.state);
    if (hit.instance == kNoInstance) {
        return environment_radiance(info, direction);
    }
    float cone_width = hit.t / (stretch * camera.focal_px);
    Surface s = make_surface(load_world_triangle(hit.instance, hit.primitive), hit.barycentrics, direction, cone_width);
    PathSettings settings = make_path_settings(params.path, params.max_indirect);
    Illumination light = trace_path(info, settings, s, direction, cone_width, 1.0 / camera.focal_px, rng);
    Bsdf b = make_bsdf(s, direction);
    vec3 diffuse = (light.diffuse + light.punctual) * b.diffuse_modulation;
    return s.emission + diffuse + light.specular * b.specular_modulation;
}

void main() {
    uvec2 id = gl_GlobalInvocationID.xy;
    if (id.x >= params.width || id.y >= params.height) {
        return;
    }
    uint pixel = id.y * params.width + id.x;
    CameraRecord camera = params.camera.at[0];
    vec3 through = camera_direction(camera, vec2(id) + 0.5);
    float stretch = length(through); // distance along the ray per metre of depth
    SceneInfo info = load_scene_info();
    uint seed = hash_combine(params.seed, pixel);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < params.samples_per_pixel; ++i) {
        Sampler rng = make_sampler(seed, params.first_sample + i);
        vec3 radiance = trace_primary(info, camera, through / stretch, stretch, rng);
        if (is_finite(radiance)) {
            sum += radiance;
        } else {
            atomicAdd(params.invalid_samples.at[0], 1u);
        }
    }
    params.film.at[pixel] += vec4(sum, float(params.samples_per_pixel));
}
