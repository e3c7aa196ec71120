#version 460
// SPDX-License-Identifier: Apache-2.0
// Smooths the light of holes over the same surface. It averages the view's other holes and, where neighbouring pixels
// of the view were taken from the source, the light in the source.
#extension GL_GOOGLE_include_directive : require
#include "shared/holes.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { HoleParams params; };

#include "lib/holes.glsl"

const int kRadius = 3;
const float kSourceFrames = 8.0; // of one hole are worth one pixel of the denoised source
const float kSlack = 2.0;        // of the distance tests, which are made for one pixel

// Adds the pixel `step` from the target's place in every source.
void gather_sources_at(CameraBuffer cameras, ivec2 step, float weight, Target target, inout Gathered around) {
    for (uint i = 0u; i < params.settings.source_count; ++i) {
        CameraRecord source = cameras.at[i];
        vec3 p = camera_project(source, target.position);
        if (p.z > 0.0) {
            gather(source, i, ivec2(floor(p.xy)) + step, weight, target, kSlack, around);
        }
    }
}

// Adds the pixels around: holes to `sum`, and light that the sources show of the others to `around`.
void gather_neighbours(HoleFrame frame, ViewPixel pixel, CameraRecord camera, Target target, inout HoleSum sum,
                       inout Gathered around) {
    for (int y = -kRadius; y <= kRadius; ++y) {
        for (int x = -kRadius; x <= kRadius; ++x) {
            ivec2 step = ivec2(x, y);
            if (step == ivec2(0)) {
                continue;
            }
            ivec2 at = ivec2(pixel.x, pixel.y) + step;
            float weight = exp(-0.25 * dot(vec2(step), vec2(step)));
            if (hole_number(frame, pixel.view, at, params.width, params.height) != kNoIndex) {
                gather_hole(frame, pixel.view, camera, at, weight, target, kSlack, true, sum);
            } else {
                gather_sources_at(frame.cameras, step, weight * kSourceFrames, target, around);
            }
        }
    }
}

void main() {
    uint number = linear_index();
    if (number >= params.hole_count) {
        return;
    }
    HoleFrame frame = params.frames.at[0];
    ViewPixel pixel = locate_pixel(frame.pixels.at[number], params.width, params.height);
    CameraRecord camera = frame.cameras.at[kMaxSources + pixel.view];
    Target target = stored_target(frame.surfaces.at[number], camera, vec2(pixel.x, pixel.y) + 0.5);
    target.tangential_limit_m *= float(kRadius); // taps are that far away on purpose; the plane decides
    HoleLight own = unpack_hole_light(frame.light.at[number]);
    float own_weight = max(own.frames, 1.0);
    HoleSum sum = HoleSum(own.diffuse * own_weight, own.specular * own_weight, 0.0, own_weight);
    Gathered around = Gathered(vec3(0.0), vec3(0.0), 0.0, kDiscardId);
    gather_neighbours(frame, pixel, camera, target, sum, around);
    HoleLight light;
    float scale = 1.0 / (sum.weight + around.weight);
    light.diffuse = (sum.diffuse + around.diffuse) * scale;
    light.specular = (sum.specular + around.specular) * scale;
    light.frames = own.frames;
    params.light_out.at[number] = pack_hole_light(light);
}
