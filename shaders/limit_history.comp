#version 460
// SPDX-License-Identifier: Apache-2.0
// SVGF+ between accumulation and filter. It keeps the long history where the short one agrees with it, fills pixels
// with hardly any history from their surroundings, and estimates the variance of the accumulated light.
// Follows: the two histories and the history fix of NVIDIA's ReLAX (D. Zhdanov, Fast Denoising with Self-Stabilizing
// Recurrent Blurs, GTC 2020). Differs: the short history is the first moment of luminance, which is there anyway.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { FilterParams params; };

#include "lib/filter_taps.glsl"

const float kYoungFrames = 4.0;
const float kLeastWeight = 0.02;   // as in svgf_variance.comp
const float kDeviations = 2.0;     // largest distance of the long history from the short one's surroundings

// Sums over the neighbourhood.
struct Neighbourhood {
    vec3 diffuse;
    vec3 specular;
    vec4 moments;
    vec2 squares; // of the first moments
    float total;
};

void add_tap(inout Neighbourhood sum, int texel, float weight, bool with_colour) {
    vec4 moments = texelFetch(moments_, texel);
    sum.moments += weight * moments;
    sum.squares += weight * moments.xz * moments.xz;
    sum.total += weight;
    if (with_colour) {
        sum.diffuse += weight * texelFetch(diffuse_, texel).rgb;
        sum.specular += weight * texelFetch(specular_, texel).rgb;
    }
}

// 7×7 pixels with gaps that close as the history grows, or 5×5 without.
Neighbourhood sum_neighbourhood(Centre c, bool is_young, float frames) {
    Neighbourhood sum = Neighbourhood(vec3(0.0), vec3(0.0), vec4(0.0), vec2(0.0), 0.0);
    int radius = is_young ? 3 : 2;
    int stride = is_young ? max(1, 4 - int(frames)) : 1;
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) {
            ivec2 offset = ivec2(x, y) * stride;
            ivec2 at = c.at + offset;
            if (is_inside(at)) {
                int texel = tap_texel(c, at);
                uvec4 other = texelFetch(geometry_, texel);
                float least = other.z == c.id ? kLeastWeight : 0.0;
                float weight = offset == ivec2(0) ? 1.0 : max(geometry_weight(c, offset, other), least);
                add_tap(sum, texel, weight, is_young);
            }
        }
    }
    return sum;
}

// Scale that brings a luminance within reach of the short history's surroundings.
float limiting_scale(float slow, float fast, float mean, float mean_of_squares) {
    float deviation = kDeviations * sqrt(max(0.0, mean_of_squares - mean * mean));
    float low = min(mean - deviation, fast);
    float high = max(mean + deviation, fast);
    return slow > 1e-6 ? clamp(slow, low, high) / slow : 1.0;
}

void store(uint pixel, vec4 diffuse, vec4 specular) {
    params.diffuse.at[pixel] = diffuse;
    params.specular.at[pixel] = specular;
}

// The variances (diffuse, specular) of the mean of `frames` frames: 1/n of one frame's, and α/(2 − α) of it once the
// weights no longer fall.
vec2 variance_of_mean(vec4 moments, vec2 squares_of_means, float frames) {
    vec2 variance = max(vec2(0.0), moments.yw - squares_of_means);
    return variance * max(1.0 / frames, params.alpha / (2.0 - params.alpha));
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
    float frames = max(texelFetch(length_, int(pixel)).x, 1.0);
    bool is_young = frames < kYoungFrames;
    Neighbourhood sum = sum_neighbourhood(load_centre(pixel, geometry), is_young, frames);
    float scale = 1.0 / sum.total;
    vec4 moments = sum.moments * scale;
    if (is_young) {
        diffuse.rgb = sum.diffuse * scale;
        specular.rgb = sum.specular * scale;
    } else {
        vec4 own = texelFetch(moments_, int(pixel));
        diffuse.rgb *= limiting_scale(luminance(diffuse.rgb), own.x, moments.x, sum.squares.x * scale);
        specular.rgb *= limiting_scale(luminance(specular.rgb), own.z, moments.z, sum.squares.y * scale);
    }
    vec2 variance = variance_of_mean(moments, is_young ? moments.xz * moments.xz : sum.squares * scale, frames);
    store(pixel, vec4(diffuse.rgb, variance.x), vec4(specular.rgb, variance.y));
}
