#version 460
// SPDX-License-Identifier: Apache-2.0
// What every pixel of a batch of views sees: primary rays through pixel centres.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/views.glsl"
#include "lib/surface.glsl"
#include "lib/traversal.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kSpecialiseBlend) const bool kHasBlend = false;
layout(push_constant, scalar) uniform Push { VisibilityParams params; };

void find_layers(uint pixel, vec3 origin, vec3 direction, float t_max) {
    float t_min = 0.0;
    for (uint layer = 0u; layer < 2u; ++layer) {
        Hit hit = trace_closest(origin, direction, t_min, t_max, kTraceBlend, 0u);
        params.layers.at[pixel * 2u + layer] = Visibility(hit.instance, hit.primitive);
        t_min = hit.instance == kNoInstance ? t_max : hit.t * 1.00001;
    }
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= params.width || id.y >= params.height) {
        return;
    }
    CameraRecord camera = params.cameras.at[id.z];
    vec3 direction = normalize(camera_direction(camera, vec2(id.xy) + 0.5));
    uint pixel = id.z * view_stride(params.width, params.height) + id.y * params.width + id.x;
    Hit hit = trace_closest(camera.origin, direction, 0.0, 1e30, kTraceSolid, 0u);
    params.visibility.at[pixel] = Visibility(hit.instance, hit.primitive);
    if (kHasBlend) {
        find_layers(pixel, camera.origin, direction, hit.instance == kNoInstance ? 1e30 : hit.t);
    }
}
