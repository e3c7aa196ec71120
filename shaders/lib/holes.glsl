// SPDX-License-Identifier: Apache-2.0
// Surfaces and light of holes, which kernels over holes share. The including kernel has `params` (HoleParams) and binds
// set 1.
#ifndef FIELDCAST_LIB_HOLES
#define FIELDCAST_LIB_HOLES
#include "lib/hole_light.glsl"
#include "lib/hole_map.glsl"
#include "lib/linear_index.glsl"
#include "lib/reprojection.glsl"
#include "lib/views.glsl"

// Weighted sum over pixels that show the same surface.
struct HoleSum {
    vec3 diffuse;
    vec3 specular;
    float frames;
    float weight;
};

// Adds a hole if it shows the target's surface. `weighs_frames`: a hole's weight is multiplied by its number of frames.
void gather_hole(HoleFrame frame, uint view, CameraRecord camera, ivec2 at, float weight, Target target, float slack,
                 bool weighs_frames, inout HoleSum sum) {
    uint number = weight > 0.0 ? hole_number(frame, view, at, params.width, params.height) : kNoIndex;
    if (number == kNoIndex) {
        return;
    }
    uvec4 surface = frame.surfaces.at[number];
    vec3 offset = camera.origin + camera_direction(camera, vec2(at) + 0.5) * uintBitsToFloat(surface.x) - target.position;
    float cos_normals = dot(unpack_normal(surface.y), target.normal);
    bool same = surface.w == target.id && abs(dot(offset, target.geometric_normal)) <= target.plane_limit_m * slack &&
                length(offset) <= target.tangential_limit_m * slack && cos_normals >= params.settings.min_normal_cos;
    if (!same) {
        return;
    }
    HoleLight light = unpack_hole_light(frame.light.at[number]);
    float c2 = cos_normals * cos_normals;
    float c4 = c2 * c2;
    weight *= c4 * c4 * (weighs_frames ? max(light.frames, 1.0) : 1.0);
    sum.diffuse += weight * light.diffuse;
    sum.specular += weight * light.specular;
    sum.frames += weight * light.frames;
    sum.weight += weight;
}

// The four holes around an image position, weighted bilinearly.
void gather_holes_around(HoleFrame frame, uint view, CameraRecord camera, vec2 p, Target target, inout HoleSum sum) {
    vec2 corner = floor(p - 0.5);
    vec2 f = p - 0.5 - corner;
    ivec2 base = ivec2(corner);
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        float weight = (step.x == 1 ? f.x : 1.0 - f.x) * (step.y == 1 ? f.y : 1.0 - f.y);
        gather_hole(frame, view, camera, base + step, weight, target, 1.0, false, sum);
    }
}

HoleLight mean_light(HoleSum sum) {
    float scale = 1.0 / sum.weight;
    return HoleLight(sum.diffuse * scale, sum.specular * scale, sum.frames * scale);
}

// A hole's surface from what start_holes.comp stored.
Target stored_target(uvec4 surface, CameraRecord camera, vec2 position) {
    float depth = uintBitsToFloat(surface.x);
    vec3 direction = camera_direction(camera, position);
    float footprint = depth / camera.focal_px;
    Target t;
    t.position = camera.origin + direction * depth;
    t.geometric_normal = unpack_normal(surface.z);
    t.normal = unpack_normal(surface.y);
    t.id = surface.w;
    float facing = max(0.1, abs(dot(t.geometric_normal, normalize(direction))));
    t.plane_limit_m = params.settings.plane_footprints * footprint + 1e-4 * depth;
    t.tangential_limit_m = params.settings.tangential_footprints * footprint / facing;
    return t;
}

#endif
