#version 460
// SPDX-License-Identifier: Apache-2.0
// Illumination of every pixel from the fit of its block, blended with the filtered frames before.
// Follows: M. Koskela et al. Blockwise Multi-Order Feature Regression for Real-Time Path-Tracing Reconstruction. ACM
// Transactions on Graphics 38(5), 2019.
// Differs: a fit that is too far from the mean of the light around the pixel, on its surface, does not express that
// light (edges of shadows, highlights, mirrors). It is brought back to the range in which noise may explain the
// difference. Sums of features can be negative or far too large, and an excess in one place comes with a lack in
// another.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"
#include "shared/bmfr.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { BmfrParams params; };

#include "lib/block_fit.glsl"

layout(set = 0, binding = kBmfrPreviousDiffuse) uniform samplerBuffer previous_diffuse_;
layout(set = 0, binding = kBmfrPreviousSpecular) uniform samplerBuffer previous_specular_;

const float kLeastWeight = 0.02; // as in svgf_variance.comp
const float kYoungFrames = 4.0;  // with a shorter history pixels look farther around
const float kDeviations = 2.0;   // of the surroundings' mean: largest distance of a fit from it

struct Light {
    vec3 diffuse;
    vec3 specular;
};

uint block_of(ivec2 at, uint page) {
    uvec2 block = uvec2(at - params.first) / kFitSide;
    return (page * params.blocks.y + block.y) * params.blocks.x + block.x;
}

Light evaluate(uint block, vec3 offset, vec3 normal) {
    FitFrame frame =
        FitFrame(params.fits.at[block].normal, params.fits.at[block].centre, params.fits.at[block].scale);
    Features f = make_features(frame, offset, normal);
    Light light = Light(params.fits.at[block].diffuse[0], params.fits.at[block].specular[0]);
    for (uint i = 0u; i < 3u; ++i) {
        light.diffuse += params.fits.at[block].diffuse[1u + i] * f.normal[i] +
                         params.fits.at[block].diffuse[4u + i] * f.position[i] +
                         params.fits.at[block].diffuse[7u + i] * f.square[i];
        light.specular += params.fits.at[block].specular[1u + i] * f.normal[i] +
                          params.fits.at[block].specular[4u + i] * f.position[i] +
                          params.fits.at[block].specular[7u + i] * f.square[i];
    }
    return light;
}

// Accumulated light around a pixel, on its surface.
struct Surroundings {
    Light mean;
    Light variance;
    float count; // of equal weights with the same variance of the mean
};

Surroundings look_around(Centre c, int radius) {
    Light sum = Light(vec3(0.0), vec3(0.0));
    Light squares = sum;
    float total = 0.0;
    float total_of_squares = 0.0;
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) {
            ivec2 offset = ivec2(x, y);
            ivec2 at = c.at + offset;
            if (!is_inside(at)) {
                continue;
            }
            int texel = tap_texel(c, at);
            uvec4 other = texelFetch(geometry_, texel);
            float least = other.z == c.id ? kLeastWeight : 0.0;
            float w = offset == ivec2(0) ? 1.0 : max(geometry_weight(c, offset, other), least);
            vec3 diffuse = texelFetch(diffuse_, texel).rgb;
            vec3 specular = texelFetch(specular_, texel).rgb;
            sum.diffuse += w * diffuse;
            sum.specular += w * specular;
            squares.diffuse += w * diffuse * diffuse;
            squares.specular += w * specular * specular;
            total += w;
            total_of_squares += w * w;
        }
    }
    Surroundings around;
    around.mean = Light(sum.diffuse / total, sum.specular / total);
    around.variance = Light(max(squares.diffuse / total - around.mean.diffuse * around.mean.diffuse, vec3(0.0)),
                            max(squares.specular / total - around.mean.specular * around.mean.specular, vec3(0.0)));
    around.count = total * total / total_of_squares;
    return around;
}

vec3 limited(vec3 fit, vec3 mean, vec3 variance, float count) {
    vec3 reach = kDeviations * sqrt(variance / max(count - 1.0, 1e-3)); // a single pixel sets no limit
    return clamp(fit, mean - reach, mean + reach);
}

void gather(int texel, float weight, inout Light sum, inout float total) {
    sum.diffuse += weight * texelFetch(previous_diffuse_, texel).rgb;
    sum.specular += weight * texelFetch(previous_specular_, texel).rgb;
    total += weight;
}

// The filtered previous frame, from the pixels that temporal.comp accepted. False if it accepted none.
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

// The block's fit, limited by the surroundings; the mean of the surroundings where there is no fit.
Light filtered(Centre c, uint page, uvec4 geometry, float frames) {
    uint block = block_of(c.at, page);
    Surroundings around = look_around(c, frames < kYoungFrames ? 3 : 2);
    float trust = params.fits.at[block].trust;
    if (trust == 0.0) {
        return around.mean;
    }
    CameraRecord camera = params.cameras.at[source_of_page(page, params.source_count)];
    Light fit = evaluate(block, camera_offset(camera, c.at, geometry), c.normal);
    fit.diffuse = limited(fit.diffuse, around.mean.diffuse, around.variance.diffuse, around.count);
    fit.specular = limited(fit.specular, around.mean.specular, around.variance.specular, around.count);
    return Light(max(mix(around.mean.diffuse, fit.diffuse, trust), vec3(0.0)),
                 max(mix(around.mean.specular, fit.specular, trust), vec3(0.0)));
}

void main() {
    uint index = listed_index(params.groups);
    if (index >= params.width * params.height * params.page_count) {
        return;
    }
    uvec4 geometry = texelFetch(geometry_, int(index));
    Light light = Light(texelFetch(diffuse_, int(index)).rgb, texelFetch(specular_, int(index)).rgb);
    if (geometry.z != 0xFFFFFFFFu) {
        Centre c = load_centre(index, geometry);
        float frames = max(texelFetch(length_, int(index)).x, 1.0);
        light = filtered(c, index / (params.width * params.height), geometry, frames);
        Light history;
        if ((params.flags & kFlagTemporal) != 0u && gather_history(index, c.page_start, history)) {
            float alpha = max(params.alpha, 1.0 / frames);
            light = Light(mix(history.diffuse, light.diffuse, alpha), mix(history.specular, light.specular, alpha));
        }
    }
    params.diffuse.at[index] = vec4(light.diffuse, 0.0);
    params.specular.at[index] = vec4(light.specular, 0.0);
}
