#version 460
// SPDX-License-Identifier: Apache-2.0
// Transmittance along each ray of a buffer, geometry only; for tests and `bench trace`.
#extension GL_GOOGLE_include_directive : require
#include "lib/traversal_solid.glsl"
#include "lib/traversal_rays.glsl"

void main() {
    find_any(gl_GlobalInvocationID.x);
}
