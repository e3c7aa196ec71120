#version 460
// SPDX-License-Identifier: Apache-2.0
// Finds the visible surfaces of the views' pixels from the numbers of the triangles that were drawn there.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"
#include "shared/scene.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { NameTrianglesParams params; };

void main() {
    uint pixel = linear_index();
    if (pixel >= params.pixel_count) {
        return;
    }
    uint number = params.numbers.at[pixel];
    Visibility seen = Visibility(kNoInstance, 0u);
    if (number < params.triangle_count) {
        seen = Visibility(params.triangles.at[number].instance, params.triangles.at[number].primitive);
    }
    params.visibility.at[pixel] = seen;
}
