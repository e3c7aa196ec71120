#version 460
// SPDX-License-Identifier: Apache-2.0
// One level of the edge-avoiding à-trous wavelet transform over diffuse and specular illumination together: B3 spline,
// 5×5 or its inner 3×3, taps `step` pixels apart (SVGF, section 4.4; variance filtered with squared weights, equation
// 2).
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { FilterParams params; };

#include "lib/filter_signal.glsl"

// 3×3 Gaussian of the variances (diffuse, specular), which are themselves noisy.
vec2 blurred_variance(Centre c, vec2 centre) {
    vec2 sum = 0.25 * centre;
    float total = 0.25;
    for (int i = 0; i < 9; ++i) {
        ivec2 offset = ivec2(i % 3 - 1, i / 3 - 1);
        ivec2 p = c.at + offset;
        if (i != 4 && is_inside(p)) {
            float w = offset.x == 0 || offset.y == 0 ? 0.125 : 0.0625;
            int texel = tap_texel(c, p);
            sum += w * vec2(texelFetch(diffuse_, texel).a, texelFetch(specular_, texel).a);
            total += w;
        }
    }
    return sum / total;
}

// Brightest luminance (diffuse, specular) of the eight pixels around on the same surface; negative: there are none.
vec2 brightest_around(Centre c) {
    vec2 brightest = vec2(-1.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 at = c.at + ivec2(i % 3 - 1, i / 3 - 1);
        if (i != 4 && is_inside(at) && texelFetch(geometry_, tap_texel(c, at)).z == c.id) {
            int texel = tap_texel(c, at);
            vec2 here = vec2(luminance(texelFetch(diffuse_, texel).rgb), luminance(texelFetch(specular_, texel).rgb));
            brightest = max(brightest, here);
        }
    }
    return brightest;
}

void limit(inout vec4 value, float brightest) {
    float l = luminance(value.rgb);
    value.rgb *= brightest >= 0.0 && l > brightest ? brightest / l : 1.0;
}

void store(uint pixel, vec4 diffuse, vec4 specular) {
    params.diffuse.at[pixel] = diffuse;
    params.specular.at[pixel] = specular;
}

// Adds the light of the taps around `c` that resemble it.
void add_taps(Centre c, inout Signal diffuse, inout Signal specular) {
    for (int y = -params.radius; y <= params.radius; ++y) {
        for (int x = -params.radius; x <= params.radius; ++x) {
            ivec2 offset = ivec2(x, y) * int(params.step);
            ivec2 at = c.at + offset;
            if (offset == ivec2(0) || !is_inside(at)) {
                continue;
            }
            int texel = tap_texel(c, at);
            uvec4 other = texelFetch(geometry_, texel);
            float weight = kFilterKernel[abs(x)] * kFilterKernel[abs(y)] * geometry_weight(c, offset, other);
            if (weight > 1e-4) {
                add_tap(diffuse, texelFetch(diffuse_, texel), weight);
                float alike = params.follows_lobes != 0u ? lobe_similarity(c, offset, other) : 1.0;
                add_tap(specular, texelFetch(specular_, texel), weight * alike);
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
    vec4 diffuse = texelFetch(diffuse_, int(pixel));
    vec4 specular = texelFetch(specular_, int(pixel));
    if (geometry.z == 0xFFFFFFFFu) {
        store(pixel, diffuse, specular);
        return;
    }
    Centre c = load_centre(pixel, geometry);
    vec2 variance = blurred_variance(c, vec2(diffuse.a, specular.a));
    Signal d = make_signal(diffuse, variance.x);
    Signal s = make_signal(specular, variance.y);
    add_taps(c, d, s);
    diffuse = resolve(d);
    specular = resolve(s);
    if (params.limits_outliers != 0u) {
        vec2 brightest = brightest_around(c);
        limit(diffuse, brightest.x);
        limit(specular, brightest.y);
    }
    store(pixel, diffuse, specular);
}
