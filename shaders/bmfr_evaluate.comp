#version 460
// SPDX-License-Identifier: Apache-2.0
// Illumination of every pixel from the fit of its block, blended with the filtered frames before.
// Follows: M. Koskela et al. Blockwise Multi-Order Feature Regression for Real-Time Path-Tracing Reconstruction. ACM
// Transactions on Graphics 38(5), 2019, section 3.4.
// Differs: where the fit is not to be trusted, a filter that stops at edges stands in.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"
#include "shared/bmfr.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { BmfrParams params; };

#include "lib/block_fit.glsl"

layout(set = 0, binding = kBmfrPreviousDiffuse) uniform samplerBuffer previous_diffuse_;
layout(set = 0, binding = kBmfrPreviousSpecular) uniform samplerBuffer previous_specular_;

const float kLeastWeight = 0.02;   // as in svgf_variance.comp
const float kMatureFrames = 4.0;   // as in bmfr_fit.comp
const float kDeviations = 4.0;     // of luminance, that neighbours may be away

struct Light {
    vec3 diffuse;
    vec3 specular;
};

uint block_of(ivec2 at, uint page) {
    uvec2 block = uvec2(at - params.first) / kFitSide;
    return (page * params.blocks.y + block.y) * params.blocks.x + block.x;
}

Light evaluate(uint block, vec3 offset, vec3 normal, vec2 material) {
    FitFrame frame = FitFrame(params.fits.at[block].normal, params.fits.at[block].centre, params.fits.at[block].scale,
                              params.fits.at[block].material);
    Features f = make_features(frame, offset, normal, material);
    Light light = Light(params.fits.at[block].diffuse[0], params.fits.at[block].specular[0]);
    for (uint i = 0u; i < 3u; ++i) {
        light.diffuse += params.fits.at[block].diffuse[1u + i] * f.normal[i] +
                         params.fits.at[block].diffuse[4u + i] * f.position[i] +
                         params.fits.at[block].diffuse[7u + i] * f.square[i];
        light.specular += params.fits.at[block].specular[1u + i] * f.normal[i] +
                          params.fits.at[block].specular[4u + i] * f.position[i] +
                          params.fits.at[block].specular[7u + i] * f.square[i];
    }
    for (uint i = 0u; i < 2u; ++i) {
        light.diffuse += params.fits.at[block].diffuse[10u + i] * f.material[i];
        light.specular += params.fits.at[block].specular[10u + i] * f.material[i];
    }
    return Light(max(light.diffuse, vec3(0.0)), max(light.specular, vec3(0.0)));
}

// Standard deviation of the accumulated luminance around a pixel; diffuse, specular.
vec2 deviation_around(Centre c) {
    vec2 sum = vec2(0.0);
    float total = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 at = c.at + ivec2(i % 3 - 1, i / 3 - 1);
        if (is_inside(at) && texelFetch(geometry_, tap_texel(c, at)).z == c.id) {
            int texel = tap_texel(c, at);
            vec4 moments = texelFetch(moments_, texel);
            float of_mean = max(1.0 / max(texelFetch(length_, texel).x, 1.0), params.noisy_alpha / (2.0 - params.noisy_alpha));
            sum += of_mean * max(vec2(0.0), moments.yw - moments.xz * moments.xz);
            total += 1.0;
        }
    }
    return sqrt(sum / max(total, 1.0));
}

// Mean of 7×7 pixels of the same surface; with gaps while the history is short and the noise is not known.
Light stand_in(Centre c, float frames, Light own) {
    bool is_mature = frames >= kMatureFrames;
    int stride = is_mature ? 1 : max(1, 4 - int(frames));
    vec2 reach = is_mature ? kDeviations * deviation_around(c) + 1e-4 : vec2(1e30);
    vec2 centre = vec2(luminance(own.diffuse), luminance(own.specular));
    Light sum = own;
    vec2 total = vec2(1.0);
    for (int i = 0; i < 49; ++i) {
        ivec2 offset = (ivec2(i % 7, i / 7) - 3) * stride;
        ivec2 at = c.at + offset;
        if (offset != ivec2(0) && is_inside(at)) {
            int texel = tap_texel(c, at);
            uvec4 other = texelFetch(geometry_, texel);
            float weight = other.z == c.id ? max(geometry_weight(c, offset, other), kLeastWeight) : 0.0;
            vec3 diffuse = texelFetch(diffuse_, texel).rgb;
            vec3 specular = texelFetch(specular_, texel).rgb;
            vec2 w = weight * exp(-abs(vec2(luminance(diffuse), luminance(specular)) - centre) / reach);
            sum.diffuse += w.x * diffuse;
            sum.specular += w.y * specular;
            total += w;
        }
    }
    return Light(sum.diffuse / total.x, sum.specular / total.y);
}

void gather(int texel, float weight, inout Light sum, inout float total) {
    sum.diffuse += weight * texelFetch(previous_diffuse_, texel).rgb;
    sum.specular += weight * texelFetch(previous_specular_, texel).rgb;
    total += weight;
}

// The filtered frame before, from the pixels that temporal.comp accepted. False: there are none.
bool gather_history(uint index, int page_start, out Light history) {
    HistoryTaps taps = params.taps.at[index];
    vec2 corner = floor(taps.position - 0.5);
    vec2 f = taps.position - 0.5 - corner;
    ivec2 nearest = ivec2(floor(taps.position));
    history = Light(vec3(0.0), vec3(0.0));
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        if ((taps.accepted & (1u << i)) != 0u) {
            ivec2 step = ivec2(i % 2, i / 2);
            ivec2 at = ivec2(corner) + step;
            vec2 w = mix(1.0 - f, f, vec2(step));
            gather(page_start + at.y * int(params.width) + at.x, w.x * w.y, history, total);
        }
    }
    for (int i = 0; i < 9 && taps.accepted >= 16u; ++i) {
        if ((taps.accepted & (16u << i)) != 0u) {
            ivec2 at = nearest + ivec2(i % 3 - 1, i / 3 - 1);
            gather(page_start + at.y * int(params.width) + at.x, 1.0, history, total);
        }
    }
    history.diffuse /= max(total, 1e-20);
    history.specular /= max(total, 1e-20);
    return total > 0.0;
}

Light filtered(Centre c, uint page, uvec4 geometry, float frames, Light own) {
    uint block = block_of(c.at, page);
    vec2 trust = params.fits.at[block].trust;
    Light light = own;
    if (any(lessThan(trust, vec2(1.0)))) {
        light = stand_in(c, frames, own);
    }
    if (any(greaterThan(trust, vec2(0.0)))) {
        Light fit = evaluate(block, camera_offset(params.camera.at[0], c.at, geometry), c.normal, unpack_material(geometry.w));
        light = Light(mix(light.diffuse, fit.diffuse, trust.x), mix(light.specular, fit.specular, trust.y));
    }
    return light;
}

void main() {
    uint index = linear_index();
    if (index >= params.width * params.height * params.page_count) {
        return;
    }
    uvec4 geometry = texelFetch(geometry_, int(index));
    Light light = Light(texelFetch(diffuse_, int(index)).rgb, texelFetch(specular_, int(index)).rgb);
    if (geometry.z != 0xFFFFFFFFu) {
        Centre c = load_centre(index, geometry);
        float frames = max(texelFetch(length_, int(index)).x, 1.0);
        light = filtered(c, index / (params.width * params.height), geometry, frames, light);
        Light history;
        if ((params.flags & kFlagTemporal) != 0u && gather_history(index, c.page_start, history)) {
            float alpha = max(params.alpha, 1.0 / frames);
            light = Light(mix(history.diffuse, light.diffuse, alpha), mix(history.specular, light.specular, alpha));
        }
    }
    params.diffuse.at[index] = vec4(light.diffuse, 0.0);
    params.specular.at[index] = vec4(light.specular, 0.0);
}
