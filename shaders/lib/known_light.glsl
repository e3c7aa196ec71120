// SPDX-License-Identifier: Apache-2.0
// Surfaces whose light in an image is also valid for other viewers.
#ifndef FIELDCAST_LIB_KNOWN_LIGHT
#define FIELDCAST_LIB_KNOWN_LIGHT
#include "lib/bsdf.glsl"

const float kMaxSpecularShare = 0.25; // largest share of a surface whose light is valid for other viewers

bool looks_alike_from_anywhere(Surface s, Bsdf b) {
    bool is_rough = s.roughness >= 0.35 || luminance(b.specular_modulation) <= 0.05;
    float specular_share = luminance(b.specular_modulation) / max(luminance(b.diffuse_modulation + b.specular_modulation), 1e-6);
    return is_rough && specular_share <= kMaxSpecularShare;
}

#endif
