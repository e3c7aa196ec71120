// SPDX-License-Identifier: Apache-2.0
// Environment, emissive triangles and punctual lights: evaluation, sampling and densities.
#ifndef FIELDCAST_LIB_LIGHTS
#define FIELDCAST_LIB_LIGHTS
#include "lib/bsdf.glsl"

const float kDeltaLight = 0.0; // density of a light that only next event estimation can find

struct LightSample {
    vec3 direction; // unit, towards the light
    float distance_m;
    vec3 weight;    // radiance or intensity over density
    float pdf;      // solid angle density, or kDeltaLight
};

SceneInfo load_scene_info() {
    vec4 a = texelFetch(scene_info_, 0);
    vec4 b = texelFetch(scene_info_, 1);
    vec4 c = texelFetch(scene_info_, 2);
    vec4 d = texelFetch(scene_info_, 3);
    SceneInfo info;
    info.sky = a.xyz;
    info.environment_width = floatBitsToUint(a.w);
    uvec4 bits = floatBitsToUint(b);
    info.environment_height = bits.x;
    info.light_count = bits.y;
    info.emitter_count = bits.z;
    info.instance_count = bits.w;
    info.probability_environment = c.x;
    info.probability_emitter = c.y;
    info.probability_light = c.z;
    info.has_blend = floatBitsToUint(c.w);
    info.centre = d.xyz;
    info.radius_m = d.w;
    return info;
}

// Equirectangular: −Z at u = 0.5, +Y at v = 0.
vec2 environment_uv(vec3 direction) {
    return vec2(0.5 + atan(direction.x, -direction.z) / (2.0 * kPi), acos(clamp(direction.y, -1.0, 1.0)) / kPi);
}

vec3 environment_direction(vec2 uv) {
    float theta = uv.y * kPi;
    float phi = (uv.x - 0.5) * 2.0 * kPi;
    return vec3(sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi));
}

// Bilinear. The sampling table is wider than one texel's own radiance, so it covers the filter's support.
vec3 environment_radiance(SceneInfo info, vec3 direction) {
    if (info.environment_width == 0u) {
        return info.sky;
    }
    vec2 uv = environment_uv(direction);
    float half_texel = 0.5 / float(info.environment_height);
    uv.y = clamp(uv.y, half_texel, 1.0 - half_texel);
    return textureLod(environment_, vec3(uv, 0.0), 0.0).rgb;
}

float pdf_environment(SceneInfo info, vec3 normal, vec3 direction) {
    if (info.environment_width == 0u) {
        return max(dot(normal, direction), 0.0) / kPi;
    }
    vec2 size = vec2(info.environment_width, info.environment_height);
    vec2 uv = environment_uv(direction);
    ivec2 texel = ivec2(min(uv * size, size - 1.0));
    float probability = texelFetch(environment_alias_, texel.y * int(info.environment_width) + texel.x).z;
    float top = cos(float(texel.y) * kPi / size.y);
    float bottom = cos(float(texel.y + 1) * kPi / size.y);
    return probability * size.x / (2.0 * kPi * max(top - bottom, 1e-9)); // texel's solid angle, exactly
}

// Index below `count`; `rest` is the position inside that index's share. A float's 24 bits are too few for the texels
// of an environment and their alias decision, so the low bits of `fine` follow those of `u`.
uint pick_index(float u, float fine, uint count, out float rest) {
    uint bits = (uint(u * 16777216.0) << 8) | (uint(fine * 16777216.0) & 255u);
    uint index;
    uint fraction;
    umulExtended(bits, count, index, fraction);
    rest = float(fraction >> 8) * (1.0 / 16777216.0);
    return index;
}

LightSample sample_environment(SceneInfo info, vec3 normal, float choice, vec2 u) {
    LightSample s;
    s.distance_m = 1e30;
    if (info.environment_width == 0u) {
        float r = sqrt(u.x);
        float phi = 2.0 * kPi * u.y;
        s.direction = normalize(frame_of(normal) * vec3(r * cos(phi), r * sin(phi), sqrt(max(1e-6, 1.0 - u.x))));
        s.pdf = max(dot(normal, s.direction), 1e-6) / kPi;
        s.weight = info.sky / s.pdf;
        return s;
    }
    float across; // inside the texel
    uint index = pick_index(u.x, u.y, info.environment_width * info.environment_height, across);
    vec4 entry = texelFetch(environment_alias_, int(index));
    index = choice < entry.x ? index : floatBitsToUint(entry.y);
    uint row = index / info.environment_width;
    uint col = index - row * info.environment_width;
    // uniform in solid angle inside the texel
    float top = cos(float(row) * kPi / float(info.environment_height));
    float bottom = cos(float(row + 1u) * kPi / float(info.environment_height));
    float cos_theta = mix(top, bottom, u.y);
    float sin_theta = sqrt(max(0.0, 1.0 - cos_theta * cos_theta));
    float phi = ((float(col) + across) / float(info.environment_width) - 0.5) * 2.0 * kPi;
    s.direction = vec3(sin_theta * sin(phi), cos_theta, -sin_theta * cos(phi));
    float probability = texelFetch(environment_alias_, int(index)).z;
    s.pdf = probability * float(info.environment_width) / (2.0 * kPi * max(top - bottom, 1e-9));
    s.weight = environment_radiance(info, s.direction) / s.pdf;
    return s;
}

// Solid angle density with which next event estimation meets `emitter` at `distance_m` under `cos_light`. `area_m2` is
// the triangle's current area, because instances may grow.
float pdf_emitter(uint emitter, float area_m2, float distance_m, float cos_light) {
    float probability = texelFetch(emitters_, int(emitter) * 2 + 1).x;
    return probability * distance_m * distance_m / max(area_m2 * cos_light, 1e-12);
}

// Coverage of the surface that light sampling found, because the tracer meets MASK and BLEND surfaces less often.
float emitter_coverage(WorldTriangle t, vec2 barycentrics) {
    uint mode = floatBitsToUint(texelFetch(materials_, int(t.material) * 5 + 3).y) & kMaterialAlphaMask;
    if (mode == kAlphaOpaque) {
        return 1.0;
    }
    float alpha = surface_alpha(t.instance, t.primitive, barycentrics);
    return mode == kAlphaBlend ? alpha : (surface_is_solid_at(t.instance, t.primitive, barycentrics) ? 1.0 : 0.0);
}

LightSample sample_emitter(SceneInfo info, vec3 position, float choice, vec2 u) {
    float rest;
    uint index = pick_index(choice, u.y, info.emitter_count, rest);
    vec4 head = texelFetch(emitters_, int(index) * 2);
    if (rest >= head.x) {
        index = floatBitsToUint(head.y);
        head = texelFetch(emitters_, int(index) * 2);
    }
    float root = sqrt(u.x);
    vec2 barycentrics = vec2(1.0 - root, u.y * root);
    WorldTriangle t = load_world_triangle(floatBitsToUint(head.z), floatBitsToUint(head.w));
    vec3 to_light = t.p0 + t.edge1 * barycentrics.x + t.edge2 * barycentrics.y - position;
    float distance_squared = max(dot(to_light, to_light), 1e-12);
    LightSample s;
    s.distance_m = sqrt(distance_squared);
    s.direction = to_light / s.distance_m;
    vec3 area_normal = cross(t.edge1, t.edge2);
    float double_area = max(length(area_normal), 1e-20);
    float cos_light = abs(dot(area_normal, s.direction)) / double_area;
    s.pdf = pdf_emitter(index, 0.5 * double_area, s.distance_m, cos_light);
    vec3 emission = make_surface(t, barycentrics, s.direction, 0.0).emission * emitter_coverage(t, barycentrics);
    s.weight = cos_light > 1e-6 ? emission / s.pdf : vec3(0.0);
    return s;
}

LightSample sample_punctual(SceneInfo info, vec3 position, float choice, vec2 u) {
    int index = 0;
    float probability = 1.0;
    for (float below = 0.0; index < int(info.light_count); ++index) {
        probability = texelFetch(lights_, index * 4 + 2).w;
        below += probability;
        if (choice < below || index + 1 == int(info.light_count)) {
            break;
        }
    }
    vec4 a = texelFetch(lights_, index * 4);
    vec4 b = texelFetch(lights_, index * 4 + 1);
    vec4 c = texelFetch(lights_, index * 4 + 2);
    vec4 d = texelFetch(lights_, index * 4 + 3);
    LightSample s;
    s.pdf = kDeltaLight;
    if (floatBitsToUint(a.w) == kLightDirectional) {
        float cos_theta = mix(1.0, d.z, u.x); // uniform over the light's disc
        float sin_theta = sqrt(max(0.0, 1.0 - cos_theta * cos_theta));
        float phi = 2.0 * kPi * u.y;
        s.direction = normalize(frame_of(-b.xyz) * vec3(sin_theta * cos(phi), sin_theta * sin(phi), cos_theta));
        s.distance_m = 1e30;
        s.weight = c.xyz / probability;
        return s;
    }
    vec3 to_light = a.xyz - position;
    float distance_squared = max(dot(to_light, to_light), 1e-8);
    s.distance_m = sqrt(distance_squared);
    s.direction = to_light / s.distance_m;
    float strength = 1.0 / distance_squared;
    if (b.w > 0.0) { // KHR_lights_punctual: range window
        float ratio = distance_squared / (b.w * b.w);
        strength *= clamp(1.0 - ratio * ratio, 0.0, 1.0);
    }
    if (floatBitsToUint(a.w) == kLightSpot) {
        float spot = clamp((dot(-s.direction, b.xyz) - d.y) / max(d.x - d.y, 1e-4), 0.0, 1.0);
        strength *= spot * spot;
    }
    s.weight = c.xyz * (strength / probability);
    return s;
}

// One sample of next event estimation over all lights. `choice` picks the kind of light and may not be used again.
LightSample sample_light(SceneInfo info, vec3 position, vec3 normal, float choice, vec2 u) {
    LightSample s;
    float probability;
    if (choice < info.probability_environment) {
        probability = info.probability_environment;
        s = sample_environment(info, normal, choice / probability, u);
    } else if (choice < info.probability_environment + info.probability_emitter) {
        probability = info.probability_emitter;
        float rest = (choice - info.probability_environment) / probability;
        s = sample_emitter(info, position, clamp(rest, 0.0, 0.99999994), u);
    } else if (info.probability_light > 0.0) {
        probability = info.probability_light;
        float rest = (choice - info.probability_environment - info.probability_emitter) / probability;
        s = sample_punctual(info, position, clamp(rest, 0.0, 0.99999994), u);
    } else { // no light at all, or probabilities that add up to a little less than 1
        return LightSample(normal, 0.0, vec3(0.0), 1.0);
    }
    s.weight /= probability;
    s.pdf *= probability;
    return s;
}

#endif
