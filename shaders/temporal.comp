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
struct Past {
    vec3 position;
    vec3 geometric_normal;
    vec3 normal;
    uint id;
    vec2 limits_m; // tap_limits_m()
    float mirror_turn; // angle between where it mirrors the camera now and then, radians
};

// Texel of a pixel of the frame before that shows the past surface; −1: it does not. `slack`: of the distance along it.
int past_texel(CameraRecord camera, uint page, ivec2 at, Past past, float slack) {
    ivec2 size = ivec2(params.width, params.height);
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) {
        return -1;
    }
    int texel = (int(page) * size.y + at.y) * size.x + at.x;
    uvec4 geometry = texelFetch(previous_geometry_, texel);
    if (geometry.z != past.id) {
        return -1;
    }
    vec3 offset = camera.origin + camera_direction(camera, vec2(at) + 0.5) * uintBitsToFloat(geometry.x) - past.position;
    vec2 limits_m = past.limits_m * vec2(1.0, slack);
    return is_same_surface(offset, geometry.y, past.geometric_normal, past.normal, limits_m) ? texel : -1;
}

bool is_punctual_apart() {
    return (params.flags & kFlagPunctualApart) != 0u;
}

void gather(CameraRecord camera, uint page, ivec2 at, float weight, Past past, uint bit, inout History sum) {
    int texel = weight > 0.0 ? past_texel(camera, page, at, past, 1.0) : -1;
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

// Illumination from 4×4 pixels where all of them show the past surface. Bilinear weights frame after frame blur what moves
// across the image; these hardly do.
void sharpen(CameraRecord camera, uint page, vec2 p, Past past, inout History sum) {
    vec2 corner = floor(p - 0.5);
    vec2 f = p - 0.5 - corner;
    ivec2 first = ivec2(corner) - 1;
    vec4 column = catmull_rom(f.x);
    vec4 row = catmull_rom(f.y);
    vec3 diffuse = vec3(0.0);
    vec3 specular = vec3(0.0);
    vec3 punctual = vec3(0.0);
    for (int i = 0; i < 16; ++i) {
        int texel = past_texel(camera, page, first + ivec2(i & 3, i >> 2), past, 2.0);
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

History gather_history(CameraRecord camera, uint page, vec2 p, Past past) {
    History sum = History(vec3(0.0), vec3(0.0), vec4(0.0), vec4(0.0), 0.0, 0.0, 0u);
    vec2 corner = floor(p - 0.5);
    vec2 f = p - 0.5 - corner;
    ivec2 base = ivec2(corner);
    gather(camera, page, base, (1.0 - f.x) * (1.0 - f.y), past, 0u, sum);
    gather(camera, page, base + ivec2(1, 0), f.x * (1.0 - f.y), past, 1u, sum);
    gather(camera, page, base + ivec2(0, 1), (1.0 - f.x) * f.y, past, 2u, sum);
    gather(camera, page, base + ivec2(1, 1), f.x * f.y, past, 3u, sum);
    bool retry = sum.weight < 0.05;
    ivec2 nearest = ivec2(floor(p));
    for (int i = 0; retry && i < 9; ++i) {
        ivec2 at = nearest + ivec2(i % 3 - 1, i / 3 - 1);
        gather(camera, page, at, 1.0, past, uint(i) + 4u, sum);
    }
    if ((params.flags & kFlagSharpHistory) != 0u && (sum.accepted & 15u) == 15u) {
        sharpen(camera, page, p, past, sum);
    }
    return sum;
}

// The pixel's surface point, moved back by its instance's motion.
Past past_surface(Visibility seen, CameraRecord now, CameraRecord before, vec2 position, vec3 normal) {
    vec3 direction = camera_direction(now, position);
    WorldTriangle t = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(t, now.origin, direction);
    mat4x3 m = load_previous_transform(seen.instance);
    vec3 corner0 = load_vertex(t.vertices.x).xyz;
    vec3 corner1 = load_vertex(t.vertices.y).xyz;
    vec3 corner2 = load_vertex(t.vertices.z).xyz;
    Past past;
    past.position = previous_position(seen.instance, t.vertices, at.xy);
    vec3 e1 = m * vec4(corner1 - corner0, 0.0);
    vec3 e2 = m * vec4(corner2 - corner0, 0.0);
    vec3 area_normal = cross(e1, e2);
    past.geometric_normal = area_normal / max(length(area_normal), 1e-30);
    float depth = dot(past.position - before.origin, before.forward);
    vec3 view = normalize(past.position - before.origin);
    past.limits_m = tap_limits_m(depth, before.focal_px, abs(dot(view, past.geometric_normal)));
    past.id = (seen.instance << 12) | t.material;
    past.normal = normal;
    vec3 area_normal_now = cross(t.edge1, t.edge2);
    vec3 turned = past.geometric_normal - area_normal_now / max(length(area_normal_now), 1e-30);
    turned *= dot(area_normal_now, normal) < 0.0 ? -1.0 : 1.0;
    vec3 mirrored = reflect(normalize(direction), normal);
    vec3 mirrored_then = reflect(view, normalize(normal + turned));
    past.mirror_turn = length(mirrored - mirrored_then); // small: chord for arc
    return past;
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

void main() {
    uint index = listed_index(params.groups);
    if (index >= params.width * params.height * params.page_count) {
        return;
    }
    PagePixel at = locate_page_pixel(index, params.width, params.height);
    vec3 diffuse = texelFetch(diffuse_, int(index)).rgb;
    vec3 specular = texelFetch(specular_, int(index)).rgb;
    float l_diffuse = luminance(diffuse);
    float l_specular = luminance(specular);
    vec4 moments = vec4(l_diffuse, l_diffuse * l_diffuse, l_specular, l_specular * l_specular);
    vec4 punctual = is_punctual_apart() ? texelFetch(punctual_, int(index)) : vec4(0.0);
    punctual.a = luminance(punctual.rgb) * luminance(punctual.rgb);
    Visibility seen = page_visibility(params.visibility, params.layers, at.page, params.source_count,
                                      view_stride(params.width, params.height), at.pixel);
    if ((params.flags & kFlagTemporal) == 0u || seen.instance == kNoInstance) {
        store(index, diffuse, specular, moments, 1.0);
        store_punctual(index, punctual);
        keep_taps(index, vec2(0.0), 0u);
        return;
    }
    uint source = source_of_page(at.page, params.source_count);
    CameraRecord now = params.cameras.at[source];
    CameraRecord before = params.cameras.at[params.source_count + source];
    uvec4 geometry = texelFetch(geometry_, int(index));
    Past past = past_surface(seen, now, before, vec2(at.x, at.y) + 0.5, unpack_normal(geometry.y));
    vec3 p = camera_project(before, past.position);
    History history = gather_history(before, at.page, p.xy, past);
    if (!(p.z > 0.0) || history.weight < 0.01) {
        store(index, diffuse, specular, moments, 1.0);
        store_punctual(index, punctual);
        keep_taps(index, vec2(0.0), 0u);
        return;
    }
    keep_taps(index, p.xy, history.accepted);
    float scale = 1.0 / history.weight;
    float frames = min(history.frames * scale + 1.0, params.alpha > 0.0 ? kMaxHistory : 1e6);
    // Light on a surface that moves is not what it was elsewhere: the short average for it.
    vec3 here = now.origin + camera_direction(now, vec2(at.x, at.y) + 0.5) * uintBitsToFloat(geometry.x);
    bool moves = length(past.position - here) > kMotionFootprints * uintBitsToFloat(geometry.x) / now.focal_px;
    float alpha = max(moves ? params.moments_alpha : params.alpha, 1.0 / frames);
    // What a smooth surface mirrored is no longer there once its lobe has turned.
    float stays = 1.0;
    if ((params.flags & kFlagFollowLobes) != 0u) {
        float roughness = float(geometry.w & 255u) / 255.0;
        stays = exp(-past.mirror_turn * past.mirror_turn * lobe_falloff(roughness, 1.0 / now.focal_px));
    }
    float moments_alpha = max(params.moments_alpha, 1.0 / frames);
    vec4 fresh = vec4(moments_alpha, moments_alpha, vec2(1.0 - (1.0 - moments_alpha) * stays));
    store(index, mix(history.diffuse * scale, diffuse, alpha),
          mix(history.specular * scale, specular, 1.0 - (1.0 - alpha) * stays),
          mix(history.moments * scale, moments, fresh), frames);
    store_punctual(index, mix(history.punctual * scale, punctual, moments_alpha));
}
