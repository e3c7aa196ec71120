#version 460
// SPDX-License-Identifier: Apache-2.0
// Path traces listed holes and blends the result with their light of the previous frame. Paths end where they meet a
// surface that the source shows, because its illumination is known there without noise.
#extension GL_GOOGLE_include_directive : require
#include "shared/holes.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { HoleParams params; };

#define PATH_ENDS_IN_KNOWN_LIGHT
#include "lib/holes.glsl"
#include "lib/listed_path.glsl"
#include "lib/source_light.glsl"

bool known_light(WorldTriangle t, vec2 barycentrics, Surface s, Bsdf b, out vec3 reflected) {
    reflected = vec3(0.0);
    return (params.stages & kHolesEndInSource) != 0u &&
           light_in_source(params.frames.at[0].cameras, s, t.instance, b, reflected);
}

void main() {
    uint item = linear_index();
    if (item >= params.counters.at[params.list]) {
        return;
    }
    uint part = params.list == kCounterFirstHoles ? 0u : 2u;
    uint number = params.lists.at[part * params.hole_count + item];
    HoleFrame frame = params.frames.at[0];
    uint index = frame.pixels.at[number];
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    CameraRecord camera = frame.cameras.at[kMaxSources + pixel.view];
    vec3 direction;
    float cone_width;
    vec2 position = vec2(pixel.x, pixel.y) + 0.5;
    Surface s = visible_surface(camera, position, params.visibility.at[index], direction, cone_width);
    uint seed = pixel_seed(params.views.at[pixel.view].seed, pixel.x, pixel.y);
    PathSettings settings = make_path_settings(params.path, params.max_indirect);
    Illumination traced = trace_illumination(settings, params.samples_per_pixel, params.counters, s, direction, cone_width,
                                             1.0 / camera.focal_px, seed);
    HoleLight light = unpack_hole_light(frame.light.at[number]);
    light.frames = min(light.frames + 1.0, params.alpha > 0.0 ? 32.0 : 2048.0); // as half floats count
    float alpha = max(params.alpha, 1.0 / light.frames);
    light.diffuse = mix(light.diffuse, traced.diffuse, alpha);
    light.specular = mix(light.specular, traced.specular, alpha);
    frame.light.at[number] = pack_hole_light(light);
}
