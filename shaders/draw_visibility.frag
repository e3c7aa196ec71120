#version 460
// SPDX-License-Identifier: Apache-2.0
// Number of the solid triangle that a pixel sees. Triangles of MASK materials count only where the ray through the
// pixel's centre meets a texel that passes.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/surface.glsl"

layout(constant_id = kSpecialiseMask) const bool kIsMask = false;
layout(location = 0) flat in uint number;
layout(location = 0) out uint seen;
layout(push_constant, scalar) uniform Push { DrawParams params; };

void main() {
    if (kIsMask) {
        CameraRecord camera = params.camera.at[0];
        Visibility triangle = params.triangles.at[number];
        vec3 at = intersect_plane(load_world_triangle(triangle.instance, triangle.primitive), camera.origin,
                                  camera_direction(camera, gl_FragCoord.xy));
        if (!surface_is_solid_at(triangle.instance, triangle.primitive, at.xy)) {
            discard;
        }
    }
    seen = number;
}
