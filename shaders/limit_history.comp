#version 460
// SPDX-License-Identifier: Apache-2.0
// SVGF+ between accumulation and filter: keeps the long history where the short one agrees with it, mends pixels with
// hardly any history from around, and estimates the variance of what was accumulated.
// Follows: the two histories and the history fix of NVIDIA's ReLAX (D. Zhdanov, Fast Denoising with Self-Stabilizing
// Recurrent Blurs, GTC 2020). Differs: the short history is the first moment of luminance, which is there anyway.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { FilterParams params; };

#include "lib/filter_taps.glsl"

const float kYoungFrames = 4.0;
const float kLeastWeight = 0.02;   // as in svgf_variance.comp
const float kDeviations = 2.0;     // that the long history may be away from the short one's surroundings

// Sums over the neighbourhood.
struct Around {
    vec3 diffuse;
    vec3 specular;
    vec4 moments;
    vec2 squares; // of the first moments
    float total;
};

void add_tap(inout Around sum, int texel, float weight, bool with_colour) {
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
Around look_around(Centre c, bool is_young, float frames) {
    Around sum = Around(vec3(0.0), vec3(0.0), vec4(0.0), vec2(0.0), 0.0);
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

void main() {
    uint pixel = listed_index(params.groups);
    if (pixel >= params.width * params.height * params.page_count) {
        return;
    }
    uvec4 geometry = texelFetch(geometry_, int(pixel));
    vec4 diffuse = texelFetch(diffuse_, int(pixel));
    vec4 specular = texelFetch(specular_, int(pixel));
    if (geometry.z == 0xFFFFFFFFu) {
        params.diffuse.at[pixel] = diffuse;
        params.specular.at[pixel] = specular;
        return;
    }
    float frames = max(texelFetch(length_, int(pixel)).x, 1.0);
    bool is_young = frames < kYoungFrames;
    Around around = look_around(load_centre(pixel, geometry), is_young, frames);
    float scale = 1.0 / around.total;
    vec4 moments = around.moments * scale;
    if (is_young) {
        diffuse.rgb = around.diffuse * scale;
        specular.rgb = around.specular * scale;
    } else {
        vec4 own = texelFetch(moments_, int(pixel));
        diffuse.rgb *= limiting_scale(luminance(diffuse.rgb), own.x, moments.x, around.squares.x * scale);
        specular.rgb *= limiting_scale(luminance(specular.rgb), own.z, moments.z, around.squares.y * scale);
    }
    // Of one frame, and of the mean of so many: 1/n, and α/(2 − α) once the weights no longer fall.
    vec2 variance = max(vec2(0.0), moments.yw - (is_young ? moments.xz * moments.xz : around.squares * scale));
    variance *= max(1.0 / frames, params.alpha / (2.0 - params.alpha));
    params.diffuse.at[pixel] = vec4(diffuse.rgb, variance.x);
    params.specular.at[pixel] = vec4(specular.rgb, variance.y);
}
