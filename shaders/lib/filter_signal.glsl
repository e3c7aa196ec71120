// SPDX-License-Identifier: Apache-2.0
// Sums of one level of an edge-avoiding filter for one kind of light: SVGF, section 4.4, equations 2 and 5. The
// including kernel has `params.sigma_luminance`.
#ifndef FIELDCAST_LIB_FILTER_SIGNAL
#define FIELDCAST_LIB_FILTER_SIGNAL
#include "lib/filter_taps.glsl"

// B3 spline, without its last taps.
const float kFilterKernel[3] = float[3](1.0, 2.0 / 3.0, 1.0 / 6.0);

struct Signal {
    vec4 sum;    // colour, variance
    float total; // of the weights
    float sigma; // of luminance
    float centre_luminance;
};

void add_tap(inout Signal s, vec4 value, float weight) {
    float w = weight * exp(-abs(luminance(value.rgb) - s.centre_luminance) / s.sigma);
    s.sum += vec4(value.rgb * w, value.a * w * w);
    s.total += w;
}

vec4 resolve(Signal s) {
    return vec4(s.sum.rgb / s.total, s.sum.a / (s.total * s.total));
}

Signal make_signal(vec4 centre, float variance) {
    return Signal(centre, 1.0, params.sigma_luminance * sqrt(max(variance, 0.0)) + 1e-4, luminance(centre.rgb));
}

#endif
