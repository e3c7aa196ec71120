#version 460
// SPDX-License-Identifier: Apache-2.0
// Finds the BLEND surfaces in front of the visible surfaces of a batch of views, in the pixels that drawing has marked.
#extension GL_GOOGLE_include_directive : require
#include "lib/blend_layers.glsl"
#include "lib/camera.glsl"
#include "lib/surface.glsl"
#include "lib/views.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { FindLayersParams params; };

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= params.width || id.y >= params.height) {
        return;
    }
    uint pixel = id.z * view_stride(params.width, params.height) + id.y * params.width + id.x;
    uint marks = params.marks.at[pixel >> 2];
    if (((marks >> (8u * (pixel & 3u))) & 255u) != 1u) {
        params.layers.at[pixel * 2u] = Visibility(kNoInstance, 0u);
        params.layers.at[pixel * 2u + 1u] = Visibility(kNoInstance, 0u);
        return;
    }
    CameraRecord camera = params.cameras.at[id.z];
    vec3 direction = normalize(camera_direction(camera, vec2(id.xy) + 0.5));
    Visibility seen = params.visibility.at[pixel];
    float t_max = 1e30;
    if (seen.instance != kNoInstance) {
        t_max = intersect_plane(load_world_triangle(seen.instance, seen.primitive), camera.origin, direction).z;
    }
    find_layers(params.layers, pixel, camera.origin, direction, t_max);
}
