#version 460
// SPDX-License-Identifier: Apache-2.0
// Temporal accumulation of illumination and its moments along surface motion.
// Follows: C. Schied et al. Spatiotemporal Variance-Guided Filtering. HPG 2017, sections 4.1 and 4.2.
// Differs: tests in world space (plane distance in pixel footprints, id, normal) instead of screen space derivatives.
#extension GL_GOOGLE_include_directive : require
#include "lib/bsdf.glsl"
#include "lib/camera.glsl"
#include "lib/history_taps.glsl"
#include "lib/linear_index.glsl"
#include "lib/lobe.glsl"
#include "lib/pages.glsl"

layout(local_size_x = kLinearGroup) in;
layout(set = 1, binding = kTemporalGeometry) uniform usamplerBuffer geometry_;
layout(set = 1, binding = kTemporalPreviousGeometry) uniform usamplerBuffer previous_geometry_;
layout(set = 1, binding = kTemporalPreviousDiffuse) uniform samplerBuffer previous_diffuse_;
layout(set = 1, binding = kTemporalPreviousSpecular) uniform samplerBuffer previous_specular_;
layout(set = 1, binding = kTemporalPreviousMoments) uniform samplerBuffer previous_moments_;
layout(set = 1, binding = kTemporalPreviousLength) uniform samplerBuffer previous_length_;
layout(set = 1, binding = kTemporalDiffuse) uniform samplerBuffer diffuse_;
layout(set = 1, binding = kTemporalSpecular) uniform samplerBuffer specular_;
layout(set = 1, binding = kTemporalPunctual) uniform samplerBuffer punctual_;
layout(set = 1, binding = kTemporalPreviousPunctual) uniform samplerBuffer previous_punctual_;
layout(push_constant, scalar) uniform Push { TemporalParams params; };

const float kMaxHistory = 64.0;
const float kMotionFootprints = 0.1; // per frame, of a surface's point

struct History {
    vec3 diffuse;
    vec3 specular;
    vec4 moments;
    vec4 punctual; // rgb, second moment of its luminance
    float frames;
    float weight;
    uint accepted; // HistoryTaps
};

// A surface point where it was in the frame before.
struct PreviousSurface {
    vec3 position;
    vec3 geometric_normal;
    vec3 normal;
    uint id;
    vec2 limits_m; // tap_limits_m()
    float mirror_turn; // angle between where it mirrors the camera now and then, radians
};

// Texel of a pixel of the frame before that shows the previous surface; −1: it does not. `slack` scales the limit of
// the distance along the surface.
int previous_texel(CameraRecord camera, uint page, ivec2 at, PreviousSurface previous, float slack) {
    ivec2 size = ivec2(params.width, params.height);
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) {
        return -1;
    }
    int texel = (int(page) * size.y + at.y) * size.x + at.x;
    uvec4 geometry = texelFetch(previous_geometry_, texel);
    if (geometry.z != previous.id) {
        return -1;
    }
    vec3 point = camera.origin + camera_direction(camera, vec2(at) + 0.5) * uintBitsToFloat(geometry.x);
    vec3 offset = point - previous.position;
    vec2 limits_m = previous.limits_m * vec2(1.0, slack);
    return is_same_surface(offset, geometry.y, previous.geometric_normal, previous.normal, limits_m) ? texel : -1;
}

bool is_punctual_apart() {
    return (params.flags & kFlagPunctualApart) != 0u;
}

void gather(CameraRecord camera, uint page, ivec2 at, float weight, PreviousSurface previous, uint bit,
            inout History sum) {
    int texel = weight > 0.0 ? previous_texel(camera, page, at, previous, 1.0) : -1;
    if (texel >= 0) {
        sum.diffuse += weight * texelFetch(previous_diffuse_, texel).rgb;
        sum.specular += weight * texelFetch(previous_specular_, texel).rgb;
        sum.moments += weight * texelFetch(previous_moments_, texel);
        if (is_punctual_apart()) {
            sum.punctual += weight * texelFetch(previous_punctual_, texel);
        }
        sum.frames += weight * texelFetch(previous_length_, texel).x;
        sum.weight += weight;
        sum.accepted |= 1u << bit;
    }
}

// Catmull-Rom weights of four pixels in a row, `f` beyond the second.
vec4 catmull_rom(float f) {
    return vec4(f * (-0.5 + f * (1.0 - 0.5 * f)), 1.0 + f * f * (1.5 * f - 2.5), f * (0.5 + f * (2.0 - 1.5 * f)),
                f * f * (0.5 * f - 0.5));
}

// Illumination from 4×4 pixels where all of them show the previous surface. Bilinear weights, applied frame after
// frame, blur surfaces that move across the image; these weights hardly do.
void sharpen(CameraRecord camera, uint page, vec2 p, PreviousSurface previous, inout History sum) {
    vec2 corner = floor(p - 0.5);
    vec2 f = p - 0.5 - corner;
    ivec2 first = ivec2(corner) - 1;
    vec4 column = catmull_rom(f.x);
    vec4 row = catmull_rom(f.y);
    vec3 diffuse = vec3(0.0);
    vec3 specular = vec3(0.0);
    vec3 punctual = vec3(0.0);
    for (int i = 0; i < 16; ++i) {
        int texel = previous_texel(camera, page, first + ivec2(i & 3, i >> 2), previous, 2.0);
        if (texel < 0) {
            return;
        }
        float weight = column[i & 3] * row[i >> 2];
        diffuse += weight * texelFetch(previous_diffuse_, texel).rgb;
        specular += weight * texelFetch(previous_specular_, texel).rgb;
        if (is_punctual_apart()) {
            punctual += weight * texelFetch(previous_punctual_, texel).rgb;
        }
    }
    sum.punctual.rgb = max(punctual, vec3(0.0)) * sum.weight;
    sum.diffuse = max(diffuse, vec3(0.0)) * sum.weight;
    sum.specular = max(specular, vec3(0.0)) * sum.weight;
}

History gather_history(CameraRecord camera, uint page, vec2 p, PreviousSurface previous) {
    History sum = History(vec3(0.0), vec3(0.0), vec4(0.0), vec4(0.0), 0.0, 0.0, 0u);
    vec2 corner = floor(p - 0.5);
    vec2 f = p - 0.5 - corner;
    ivec2 base = ivec2(corner);
    gather(camera, page, base, (1.0 - f.x) * (1.0 - f.y), previous, 0u, sum);
    gather(camera, page, base + ivec2(1, 0), f.x * (1.0 - f.y), previous, 1u, sum);
    gather(camera, page, base + ivec2(0, 1), (1.0 - f.x) * f.y, previous, 2u, sum);
    gather(camera, page, base + ivec2(1, 1), f.x * f.y, previous, 3u, sum);
    bool retry = sum.weight < 0.05;
    ivec2 nearest = ivec2(floor(p));
    for (int i = 0; retry && i < 9; ++i) {
        ivec2 at = nearest + ivec2(i % 3 - 1, i / 3 - 1);
        gather(camera, page, at, 1.0, previous, uint(i) + 4u, sum);
    }
    if ((params.flags & kFlagSharpHistory) != 0u && (sum.accepted & 15u) == 15u) {
        sharpen(camera, page, p, previous, sum);
    }
    return sum;
}

// The pixel's surface point, moved back by its instance's motion.
PreviousSurface previous_surface(Visibility seen, CameraRecord now, CameraRecord before, vec2 position, vec3 normal) {
    vec3 direction = camera_direction(now, position);
    WorldTriangle t = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(t, now.origin, direction);
    mat4x3 m = load_previous_transform(seen.instance);
    vec3 corner0 = load_vertex(t.vertices.x).xyz;
    vec3 corner1 = load_vertex(t.vertices.y).xyz;
    vec3 corner2 = load_vertex(t.vertices.z).xyz;
    PreviousSurface previous;
    previous.position = previous_position(seen.instance, t.vertices, at.xy);
    vec3 e1 = m * vec4(corner1 - corner0, 0.0);
    vec3 e2 = m * vec4(corner2 - corner0, 0.0);
    vec3 area_normal = cross(e1, e2);
    previous.geometric_normal = area_normal / max(length(area_normal), 1e-30);
    float depth = dot(previous.position - before.origin, before.forward);
    vec3 view = normalize(previous.position - before.origin);
    previous.limits_m = tap_limits_m(depth, before.focal_px, abs(dot(view, previous.geometric_normal)));
    previous.id = (seen.instance << 12) | t.material;
    previous.normal = normal;
    vec3 area_normal_now = cross(t.edge1, t.edge2);
    vec3 turned = previous.geometric_normal - area_normal_now / max(length(area_normal_now), 1e-30);
    turned *= dot(area_normal_now, normal) < 0.0 ? -1.0 : 1.0;
    vec3 mirrored = reflect(normalize(direction), normal);
    vec3 mirrored_then = reflect(view, normalize(normal + turned));
    previous.mirror_turn = length(mirrored - mirrored_then); // small: chord for arc
    return previous;
}

void store(uint pixel, vec3 diffuse, vec3 specular, vec4 moments, float frames) {
    params.diffuse.at[pixel] = vec4(diffuse, max(0.0, moments.y - moments.x * moments.x));
    params.specular.at[pixel] = vec4(specular, max(0.0, moments.w - moments.z * moments.z));
    params.moments.at[pixel] = moments;
    params.history_length.at[pixel] = frames;
}

void store_punctual(uint pixel, vec4 punctual) {
    if (is_punctual_apart()) {
        params.punctual.at[pixel] = punctual;
    }
}

void keep_taps(uint pixel, vec2 position, uint accepted) {
    if ((params.flags & kFlagKeepTaps) != 0u) {
        params.taps.at[pixel] = HistoryTaps(position, accepted);
    }
}

// Values of a pixel in one frame, before they are averaged.
struct Sample {
    vec3 diffuse;
    vec3 specular;
    vec4 moments;
    vec4 punctual; // rgb, second moment of its luminance
};

Sample load_sample(int texel) {
    Sample fresh;
    fresh.diffuse = texelFetch(diffuse_, texel).rgb;
    fresh.specular = texelFetch(specular_, texel).rgb;
    float l_diffuse = luminance(fresh.diffuse);
    float l_specular = luminance(fresh.specular);
    fresh.moments = vec4(l_diffuse, l_diffuse * l_diffuse, l_specular, l_specular * l_specular);
    fresh.punctual = is_punctual_apart() ? texelFetch(punctual_, texel) : vec4(0.0);
    fresh.punctual.a = luminance(fresh.punctual.rgb) * luminance(fresh.punctual.rgb);
    return fresh;
}

// The history starts anew with this frame.
void start_history(uint index, Sample fresh) {
    store(index, fresh.diffuse, fresh.specular, fresh.moments, 1.0);
    store_punctual(index, fresh.punctual);
    keep_taps(index, vec2(0.0), 0u);
}

// Share of the specular history that is kept: a smooth surface loses its old reflection once its lobe has turned.
float specular_share(uvec4 geometry, float mirror_turn, float pixel_angle) {
    if ((params.flags & kFlagFollowLobes) == 0u) {
        return 1.0;
    }
    float roughness = float(geometry.w & 255u) / 255.0;
    return exp(-mirror_turn * mirror_turn * lobe_falloff(roughness, pixel_angle));
}

// Whether the surface at `position` moves. Its light then changes with its place, so it has the short average.
bool is_moving(CameraRecord now, vec2 position, float depth, vec3 previous_position) {
    vec3 here = now.origin + camera_direction(now, position) * depth;
    return length(previous_position - here) > kMotionFootprints * depth / now.focal_px;
}

// Averages the frame with the history. `alpha` is the least weight of the frame's illumination, `stays` the share of
// the specular history that counts.
void blend_history(uint index, Sample fresh, History history, float alpha, float stays) {
    float scale = 1.0 / history.weight;
    float frames = min(history.frames * scale + 1.0, params.alpha > 0.0 ? kMaxHistory : 1e6);
    alpha = max(alpha, 1.0 / frames);
    float moments_alpha = max(params.moments_alpha, 1.0 / frames);
    vec4 weights = vec4(moments_alpha, moments_alpha, vec2(1.0 - (1.0 - moments_alpha) * stays));
    store(index, mix(history.diffuse * scale, fresh.diffuse, alpha),
          mix(history.specular * scale, fresh.specular, 1.0 - (1.0 - alpha) * stays),
          mix(history.moments * scale, fresh.moments, weights), frames);
    store_punctual(index, mix(history.punctual * scale, fresh.punctual, moments_alpha));
}

void accumulate(uint index, PagePixel at, Visibility seen, Sample fresh) {
    uint source = source_of_page(at.page, params.source_count);
    CameraRecord now = params.cameras.at[source];
    CameraRecord before = params.cameras.at[params.source_count + source];
    uvec4 geometry = texelFetch(geometry_, int(index));
    vec2 position = vec2(at.x, at.y) + 0.5;
    PreviousSurface previous = previous_surface(seen, now, before, position, unpack_normal(geometry.y));
    vec3 p = camera_project(before, previous.position);
    History history = gather_history(before, at.page, p.xy, previous);
    if (!(p.z > 0.0) || history.weight < 0.01) {
        start_history(index, fresh);
        return;
    }
    keep_taps(index, p.xy, history.accepted);
    bool moves = is_moving(now, position, uintBitsToFloat(geometry.x), previous.position);
    float stays = specular_share(geometry, previous.mirror_turn, 1.0 / now.focal_px);
    blend_history(index, fresh, history, moves ? params.moments_alpha : params.alpha, stays);
}

void main() {
    uint index = listed_index(params.groups);
    if (index >= params.width * params.height * params.page_count) {
        return;
    }
    PagePixel at = locate_page_pixel(index, params.width, params.height);
    Sample fresh = load_sample(int(index));
    Visibility seen = page_visibility(params.visibility, params.layers, at.page, params.source_count,
                                      view_stride(params.width, params.height), at.pixel);
    if ((params.flags & kFlagTemporal) == 0u || seen.instance == kNoInstance) {
        start_history(index, fresh);
    } else {
        accumulate(index, at, seen, fresh);
    }
}
