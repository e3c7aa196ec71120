// SPDX-License-Identifier: Apache-2.0
// Ray traversal: one interface, two implementations. Kernels that trace rays are compiled once per implementation.
//
//   Hit trace_closest(vec3 origin, vec3 direction, float t_min, float t_max, uint mode, uint seed);
//       The nearest surface with t_min < t < t_max; `direction` need not be unit length, t counts in its lengths.
//       `seed` matters for kTraceStochastic only.
//   float trace_transmittance(vec3 origin, vec3 direction, float t_max);
//       0 if a solid surface lies in 0 < t < t_max, else the product of (1 − alpha) over the BLEND surfaces there.
//
// Triangles are met from both sides. Kernels must be specialised with Acceleration::specialisations().
#ifndef FIELDCAST_LIB_TRAVERSAL
#define FIELDCAST_LIB_TRAVERSAL
#include "lib/random.glsl"
#include "shared/bvh.h"
#include "shared/scene.h"

struct Hit {
    float t;
    uint instance;     // kNoInstance: nothing was met
    uint primitive;
    vec2 barycentrics; // weights of vertices 1 and 2
};

// Which surfaces count.
const uint kTraceSolid = 0u;      // opaque, and MASK texels that pass; BLEND surfaces are skipped
const uint kTraceBlend = 1u;      // only BLEND surfaces
const uint kTraceStochastic = 2u; // opaque, MASK texels that pass, BLEND with probability alpha

layout(constant_id = 100) const bool kSceneHasAlpha = true; // kSpecialiseAlpha

// Alpha of surfaces, from lib/surface.glsl.
bool surface_is_solid_at(uint instance, uint primitive, vec2 barycentrics); // MASK: the texel passes
float surface_alpha(uint instance, uint primitive, vec2 barycentrics);      // BLEND: coverage

// Whether a candidate whose material is MASK or BLEND counts in `mode`.
bool alpha_accepts(uint alpha_mode, uint mode, uint seed, uint instance, uint primitive, vec2 barycentrics) {
    if (alpha_mode == kAlphaMask) {
        return mode != kTraceBlend && surface_is_solid_at(instance, primitive, barycentrics);
    }
    if (mode != kTraceStochastic) {
        return mode == kTraceBlend;
    }
    float threshold = unit_float(hash_combine(hash_combine(seed, instance), primitive));
    return threshold < surface_alpha(instance, primitive, barycentrics);
}

#ifdef TRAVERSAL_RAY_QUERY
#include "lib/traversal_ray_query.glsl"
#else
#include "lib/traversal_bvh.glsl"
#endif

#endif
