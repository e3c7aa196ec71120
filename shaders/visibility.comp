#version 460
// SPDX-License-Identifier: Apache-2.0
// Visible surface of every pixel of a batch of views, by primary rays through pixel centres.
#extension GL_GOOGLE_include_directive : require
#include "lib/blend_layers.glsl"
#include "lib/camera.glsl"
#include "lib/surface.glsl"
#include "lib/views.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kSpecialiseBlend) const bool kHasBlend = false;
layout(push_constant, scalar) uniform Push { VisibilityParams params; };

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
        find_layers(params.layers, pixel, camera.origin, direction, hit.instance == kNoInstance ? 1e30 : hit.t);
    }
}
