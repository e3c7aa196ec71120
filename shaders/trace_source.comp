#version 460
// SPDX-License-Identifier: Apache-2.0
// Path traces every pixel of the sources, every page; writes noisy demodulated illumination.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/linear_index.glsl"
#include "lib/pages.glsl"
#define PATH_ENDS_IN_KNOWN_LIGHT
#include "lib/path.glsl"

layout(local_size_x = kTileSide, local_size_y = kTileSide) in;
layout(push_constant, scalar) uniform Push { TraceSourceParams params; };

#include "lib/history_light.glsl"

bool known_light(WorldTriangle t, vec2 barycentrics, Surface s, Bsdf b, out vec3 reflected) {
    reflected = vec3(0.0);
    return (params.path & kPathEndsInHistory) != 0u && light_in_history(t, barycentrics, s, b, reflected);
}

void add_samples(uint index, PagePixel at, Surface s, vec3 direction, float cone_width, float cone_spread,
                 inout Illumination sum) {
    SceneInfo info = load_scene_info();
    PathSettings settings = make_path_settings(params.path, params.max_indirect);
    bool is_shared = (params.path & kPathScreenSampler) != 0u;
    uint seed = hash_combine(params.seed, is_shared ? at.page : index);
    for (uint i = 0u; i < params.samples_per_pixel; ++i) {
        uint number = params.first_sample + i;
        Sampler rng = is_shared ? make_screen_sampler(seed, number, uvec2(at.x, at.y)) : make_sampler(seed, number);
        Illumination one = trace_path(info, settings, s, direction, cone_width, cone_spread, rng);
        if (is_finite(one.diffuse + one.specular + one.punctual)) {
            sum.diffuse += one.diffuse;
            sum.specular += one.specular;
            sum.punctual += one.punctual;
        } else {
            atomicAdd(params.invalid_samples.at[0], 1u);
        }
    }
}

void main() {
    uint tile = listed_group(params.tiles);
    PagePixel at = tile_pixel(tile, gl_LocalInvocationID.xy, params.width, params.height);
    if (tile == 0xFFFFFFFFu || at.x >= params.width || at.y >= params.height) {
        return;
    }
    uint index = at.page * params.width * params.height + at.pixel;
    Visibility seen = page_visibility(params.visibility, params.layers, at.page, params.source_count,
                                      view_stride(params.width, params.height), at.pixel);
    Illumination sum = kNoIllumination;
    if (seen.instance != kNoInstance) {
        CameraRecord camera = params.cameras.at[source_of_page(at.page, params.source_count)];
        vec3 direction = camera_direction(camera, vec2(at.x, at.y) + 0.5);
        WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
        vec3 meets = intersect_plane(triangle, camera.origin, direction);
        float cone_width = meets.z / camera.focal_px;
        direction = normalize(direction);
        Surface s = make_surface(triangle, meets.xy, direction, cone_width);
        add_samples(index, at, s, direction, cone_width, 1.0 / camera.focal_px, sum);
    }
    float scale = 1.0 / float(params.samples_per_pixel);
    bool is_apart = (params.path & kPathPunctualApart) != 0u;
    params.diffuse.at[index] = vec4((is_apart ? sum.diffuse : sum.diffuse + sum.punctual) * scale, 0.0);
    if (is_apart) {
        params.punctual.at[index] = vec4(sum.punctual * scale, 0.0);
    }
    params.specular.at[index] = vec4(sum.specular * scale, 0.0);
}
