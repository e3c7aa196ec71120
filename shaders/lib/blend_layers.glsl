// SPDX-License-Identifier: Apache-2.0
// BLEND surfaces in front of the visible surface of a pixel.
#ifndef FIELDCAST_LIB_BLEND_LAYERS
#define FIELDCAST_LIB_BLEND_LAYERS
#include "lib/traversal.glsl"
#include "shared/frame.h"

// The nearest two BLEND surfaces with t < `t_max`, nearest first.
void find_layers(VisibilityBuffer layers, uint pixel, vec3 origin, vec3 direction, float t_max) {
    float t_min = 0.0;
    for (uint layer = 0u; layer < kMaxLayers; ++layer) {
        Hit hit = trace_closest(origin, direction, t_min, t_max, kTraceBlend, 0u);
        layers.at[pixel * kMaxLayers + layer] = Visibility(hit.instance, hit.primitive);
        t_min = hit.instance == kNoInstance ? t_max : hit.t * 1.00001;
    }
}

#endif
