#version 460
// SPDX-License-Identifier: Apache-2.0
// Path traces every pixel of the sources, every page; writes noisy demodulated illumination.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/pages.glsl"
#include "lib/path.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { TraceSourceParams params; };

void add_samples(uint index, Surface s, vec3 direction, float cone_width, float cone_spread, inout Illumination sum) {
    SceneInfo info = load_scene_info();
    PathSettings settings = make_path_settings(params.path, params.max_indirect);
    uint seed = hash_combine(params.seed, index);
    for (uint i = 0u; i < params.samples_per_pixel; ++i) {
        Sampler rng = make_sampler(seed, params.first_sample + i);
        Illumination one = trace_path(info, settings, s, direction, cone_width, cone_spread, rng);
        if (is_finite(one.diffuse + one.specular)) {
            sum.diffuse += one.diffuse;
            sum.specular += one.specular;
        } else {
            atomicAdd(params.invalid_samples.at[0], 1u);
        }
    }
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= params.width || id.y >= params.height) {
        return;
    }
    uint pixel = id.y * params.width + id.x;
    uint index = id.z * params.width * params.height + pixel;
    Visibility seen = page_visibility(params.visibility, params.layers, id.z, params.source_count,
                                      view_stride(params.width, params.height), pixel);
    Illumination sum = Illumination(vec3(0.0), vec3(0.0));
    if (seen.instance != kNoInstance) {
        CameraRecord camera = params.cameras.at[source_of_page(id.z, params.source_count)];
        vec3 direction = camera_direction(camera, vec2(id.xy) + 0.5);
        WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
        vec3 at = intersect_plane(triangle, camera.origin, direction);
        float cone_width = at.z / camera.focal_px;
        direction = normalize(direction);
        Surface s = make_surface(triangle, at.xy, direction, cone_width);
        add_samples(index, s, direction, cone_width, 1.0 / camera.focal_px, sum);
    }
    float scale = 1.0 / float(params.samples_per_pixel);
    params.diffuse.at[index] = vec4(sum.diffuse * scale, 0.0);
    params.specular.at[index] = vec4(sum.specular * scale, 0.0);
}
