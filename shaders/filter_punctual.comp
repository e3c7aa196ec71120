#version 460
// SPDX-License-Identifier: Apache-2.0
// One level of the edge-avoiding filter of svgf_atrous.comp over light that comes straight from punctual lights. Its
// only noise is that of penumbrae and of the choice between lights; where its variance is 0, a shadow's edge stays as
// it is.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { FilterPunctualParams params; };

#include "lib/filter_signal.glsl"

const float kYoungFrames = 4.0; // as in limit_history.comp

// Variance of the mean in a texel, from its history: 1/n of one frame's, or α/(2 − α) once the weights no longer fall.
float variance_of(int texel) {
    vec4 light = texelFetch(diffuse_, texel);
    if (params.has_moments == 0u) {
        return light.a;
    }
    float frames = max(texelFetch(length_, texel).x, 1.0);
    float mean = luminance(light.rgb);
    return max(0.0, light.a - mean * mean) * max(1.0 / frames, params.alpha / (2.0 - params.alpha));
}

// Variance of a pixel's mean, from its own history, or from 5×5 pixels of its surface where that is too short.
float estimate_variance(Centre c) {
    float frames = texelFetch(length_, tap_texel(c, c.at)).x;
    bool is_young = params.has_moments != 0u && frames < kYoungFrames;
    int radius = is_young ? 2 : 1;
    float variance = 0.0;
    vec2 moments = vec2(0.0);
    float total = 0.0;
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) {
            ivec2 at = c.at + ivec2(x, y);
            if (!is_inside(at)) {
                continue;
            }
            int texel = tap_texel(c, at);
            if (is_young) {
                float weight = geometry_weight(c, ivec2(x, y), texelFetch(geometry_, texel));
                vec4 light = texelFetch(diffuse_, texel);
                moments += weight * vec2(luminance(light.rgb), light.a);
                total += weight;
            } else {
                float weight = 0.25 / float(1 << (abs(x) + abs(y))); // 3×3 Gaussian
                variance += weight * variance_of(texel);
                total += weight;
            }
        }
    }
    moments /= max(total, 1e-6);
    return is_young ? max(0.0, moments.y - moments.x * moments.x) / max(frames, 1.0) : variance / total;
}

// Adds the light of the taps around `c` that resemble it.
void add_taps(Centre c, inout Signal signal) {
    for (int y = -params.radius; y <= params.radius; ++y) {
        for (int x = -params.radius; x <= params.radius; ++x) {
            ivec2 offset = ivec2(x, y) * int(params.step);
            ivec2 at = c.at + offset;
            if (offset == ivec2(0) || !is_inside(at)) {
                continue;
            }
            int texel = tap_texel(c, at);
            float weight = kFilterKernel[abs(x)] * kFilterKernel[abs(y)] *
                           geometry_weight(c, offset, texelFetch(geometry_, texel));
            if (weight > 1e-4) {
                add_tap(signal, vec4(texelFetch(diffuse_, texel).rgb, variance_of(texel)), weight);
            }
        }
    }
}

void main() {
    uint pixel = listed_index(params.groups);
    if (pixel >= params.width * params.height * params.page_count) {
        return;
    }
    uvec4 geometry = texelFetch(geometry_, int(pixel));
    vec4 light = texelFetch(diffuse_, int(pixel));
    if (geometry.z == 0xFFFFFFFFu) {
        params.punctual.at[pixel] = vec4(light.rgb, 0.0);
        return;
    }
    Centre c = load_centre(pixel, geometry);
    light.a = variance_of(int(pixel));
    Signal s = make_signal(light, estimate_variance(c));
    add_taps(c, s);
    params.punctual.at[pixel] = resolve(s);
}
