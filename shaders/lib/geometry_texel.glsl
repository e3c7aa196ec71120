// SPDX-License-Identifier: Apache-2.0
// Surface of a pixel for filters (GeometryTexel of shared/frame.h).
#ifndef FIELDCAST_LIB_GEOMETRY_TEXEL
#define FIELDCAST_LIB_GEOMETRY_TEXEL
#include "lib/surface.glsl"

const uvec4 kNoSurface = uvec4(0x7F800000u, 0u, kNoIndex, 0u);

uvec4 geometry_texel(Surface s, uint instance, float depth) {
    uint material = uint(s.roughness * 255.0 + 0.5) | (uint(s.metallic * 255.0 + 0.5) << 8);
    return uvec4(floatBitsToUint(depth), pack_normal(s.normal), (instance << 12) | s.material, material);
}

#endif
