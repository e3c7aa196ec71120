#version 460
// SPDX-License-Identifier: Apache-2.0
// Fills holes from the holes of the corner views, which were filled before. If an inner view uncovers a surface behind
// an edge, the outermost view on the same side uncovers it as well. Lists the holes that remain.
#extension GL_GOOGLE_include_directive : require
#include "shared/holes.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { HoleParams params; };

#include "lib/holes.glsl"

void main() {
    uint item = linear_index();
    if (item >= params.counters.at[kCounterInnerHoles]) {
        return;
    }
    uint number = params.lists.at[params.hole_count + item];
    HoleFrame frame = params.frames.at[0];
    ViewPixel pixel = locate_pixel(frame.pixels.at[number], params.width, params.height);
    CameraRecord camera = frame.cameras.at[kMaxSources + pixel.view];
    Target target = stored_target(frame.surfaces.at[number], camera, vec2(pixel.x, pixel.y) + 0.5);
    HoleSum sum = HoleSum(vec3(0.0), vec3(0.0), 0.0, 0.0);
    for (uint i = 0u; i < 4u; ++i) {
        uint view = (params.corner_views >> (8u * i)) & 0xFFu;
        if (view == kNoCornerView) {
            continue;
        }
        CameraRecord corner = frame.cameras.at[kMaxSources + view];
        vec3 p = camera_project(corner, target.position);
        if (p.z > 0.0) {
            gather_holes_around(frame, view, corner, p.xy, target, sum);
        }
    }
    if (sum.weight >= params.settings.min_weight) {
        frame.light.at[number] = pack_hole_light(mean_light(sum));
    } else {
        uint slot = atomicAdd(params.counters.at[kCounterRestHoles], 1u);
        params.lists.at[2u * params.hole_count + slot] = number;
    }
}
