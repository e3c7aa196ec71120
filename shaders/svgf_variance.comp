#version 460
// SPDX-License-Identifier: Apache-2.0
// Spatial estimate of the variance where the history is shorter than four frames (SVGF, section 4.2).
// Differs: pixels of the same surface always count a little, so that thin and strongly curved parts, which find no
// partner by normal and depth, do not stay at one sample (black specks along outlines).
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { FilterParams params; };

#include "lib/filter_taps.glsl"

const float kLeastWeight = 0.02; // 48 taps: together at most as much as the pixel itself

void pass_through(uint pixel) {
    params.diffuse.at[pixel] = texelFetch(diffuse_, int(pixel));
    params.specular.at[pixel] = texelFetch(specular_, int(pixel));
}

// Weighted sums over 7×7 pixels.
struct Neighbourhood {
    vec3 diffuse;
    vec3 specular;
    vec4 moments;
    float total;
};

Neighbourhood sum_neighbourhood(Centre c) {
    Neighbourhood sum = Neighbourhood(vec3(0.0), vec3(0.0), vec4(0.0), 0.0);
    for (int y = -3; y <= 3; ++y) {
        for (int x = -3; x <= 3; ++x) {
            ivec2 offset = ivec2(x, y);
            ivec2 at = c.at + offset;
            if (is_inside(at)) {
                int texel = tap_texel(c, at);
                uvec4 other = texelFetch(geometry_, texel);
                float least = other.z == c.id ? kLeastWeight : 0.0;
                float weight = offset == ivec2(0) ? 1.0 : max(geometry_weight(c, offset, other), least);
                sum.diffuse += weight * texelFetch(diffuse_, texel).rgb;
                sum.specular += weight * texelFetch(specular_, texel).rgb;
                sum.moments += weight * texelFetch(moments_, texel);
                sum.total += weight;
            }
        }
    }
    return sum;
}

void main() {
    uint pixel = listed_index(params.groups);
    if (pixel >= params.width * params.height * params.page_count) {
        return;
    }
    uvec4 geometry = texelFetch(geometry_, int(pixel));
    float frames = texelFetch(length_, int(pixel)).x;
    if (frames >= 4.0 || geometry.z == 0xFFFFFFFFu) {
        pass_through(pixel);
        return;
    }
    Neighbourhood sum = sum_neighbourhood(load_centre(pixel, geometry));
    vec4 moments = sum.moments / sum.total;
    float boost = 4.0 / max(frames, 1.0);
    params.diffuse.at[pixel] = vec4(sum.diffuse / sum.total, max(0.0, moments.y - moments.x * moments.x) * boost);
    params.specular.at[pixel] = vec4(sum.specular / sum.total, max(0.0, moments.w - moments.z * moments.z) * boost);
}
