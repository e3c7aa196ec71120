// SPDX-License-Identifier: Apache-2.0
// Origins of rays that leave a surface.
// Follows: C. Wächter, N. Binder. A Fast and Robust Method for Avoiding Self-Intersection. Ray Tracing Gems, 2019.
#ifndef FIELDCAST_LIB_RAY_ORIGIN
#define FIELDCAST_LIB_RAY_ORIGIN
#include "lib/surface.glsl"

vec3 offset_origin(vec3 p, vec3 normal) {
    ivec3 steps = ivec3(256.0 * normal);
    vec3 moved = intBitsToFloat(floatBitsToInt(p) + ivec3(p.x < 0.0 ? -steps.x : steps.x, p.y < 0.0 ? -steps.y : steps.y,
                                                          p.z < 0.0 ? -steps.z : steps.z));
    vec3 near_zero = p + normal * (1.0 / 65536.0);
    return vec3(abs(p.x) < 1.0 / 32.0 ? near_zero.x : moved.x, abs(p.y) < 1.0 / 32.0 ? near_zero.y : moved.y,
                abs(p.z) < 1.0 / 32.0 ? near_zero.z : moved.z);
}

vec3 path_origin(Surface s, vec3 direction) {
    bool above = dot(s.geometric_normal, direction) > 0.0;
    return offset_origin(s.position, above ? s.geometric_normal : -s.geometric_normal);
}

#endif
