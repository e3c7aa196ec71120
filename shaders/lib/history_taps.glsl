// SPDX-License-Identifier: Apache-2.0
// Tests whether a pixel of the previous frame shows a point of a surface, in world space. Distances are in footprints
// of that frame's pixels.
#ifndef FIELDCAST_LIB_HISTORY_TAPS
#define FIELDCAST_LIB_HISTORY_TAPS
#include "lib/packing.glsl"
#include "lib/scene_data.glsl"

// Position of a point of a triangle in the previous frame.
vec3 previous_position(uint instance, uvec3 vertices, vec2 barycentrics) {
    vec3 object = load_vertex(vertices.x).xyz * (1.0 - barycentrics.x - barycentrics.y) +
                  load_vertex(vertices.y).xyz * barycentrics.x + load_vertex(vertices.z).xyz * barycentrics.y;
    return load_previous_transform(instance) * vec4(object, 1.0);
}

// Largest distances between the point and the place that a pixel shows: off the point's plane (x) and along it (y),
// metres. `cosine`: between the surface and the direction towards the camera.
vec2 tap_limits_m(float depth, float focal_px, float cosine) {
    float footprint_m = max(depth, 0.0) / focal_px;
    return vec2(1.5 * footprint_m + 1e-4 * depth, 2.5 * footprint_m / max(0.1, cosine));
}

// `offset`: from the point to the place that the pixel shows. `packed_normal`: shading normal at that place.
bool is_same_surface(vec3 offset, uint packed_normal, vec3 geometric_normal, vec3 normal, vec2 limits_m) {
    return abs(dot(offset, geometric_normal)) <= limits_m.x && length(offset) <= limits_m.y &&
           dot(unpack_normal(packed_normal), normal) >= 0.5;
}

#endif
