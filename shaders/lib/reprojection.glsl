// SPDX-License-Identifier: Apache-2.0
// Backward reprojection: source pixels that show the surface point a target pixel sees. The including kernel has
// `params.settings` (ReprojectSettings) and binds set 1.
// Follows: M. Mäkitalo et al. Real-Time Light Field Path Tracing. CGI 2022, section 3.2.
// Differs: illumination instead of radiance; thresholds follow the pixel footprint, so no constants per scene.
#ifndef FIELDCAST_LIB_REPROJECTION
#define FIELDCAST_LIB_REPROJECTION
#include "lib/camera.glsl"
#include "lib/packing.glsl"
#include "lib/surface.glsl"

layout(set = 1, binding = kReprojectGeometry) uniform usamplerBuffer source_geometry_;
layout(set = 1, binding = kReprojectIllumination) uniform usamplerBuffer source_illumination_;

// The target's surface point as the tests need it.
struct Target {
    vec3 position;
    vec3 geometric_normal;
    vec3 normal;
    uint id;
    float plane_limit_m;
    float tangential_limit_m;
};

struct Gathered {
    vec3 diffuse;
    vec3 specular;
    float weight;
    uint reason; // of the tap that got furthest
};

// Adds one source pixel if it shows the target's surface.
void gather(CameraRecord source, uint page, ivec2 at, float weight, Target target, float slack, inout Gathered sum) {
    ivec2 size = ivec2(camera_size(source));
    if (weight <= 0.0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) {
        return;
    }
    int texel = (int(page) * size.y + at.y) * size.x + at.x;
    uvec4 geometry = texelFetch(source_geometry_, texel);
    if (geometry.z != target.id) {
        return;
    }
    vec3 position = source.origin + camera_direction(source, vec2(at) + 0.5) * uintBitsToFloat(geometry.x);
    vec3 offset = position - target.position;
    sum.reason = max(sum.reason, kDiscardPlane);
    if (abs(dot(offset, target.geometric_normal)) > target.plane_limit_m * slack ||
        length(offset) > target.tangential_limit_m * slack) {
        return;
    }
    sum.reason = max(sum.reason, kDiscardNormal);
    float cos_normals = dot(unpack_normal(geometry.y), target.normal);
    if (cos_normals < params.settings.min_normal_cos) {
        return;
    }
    float c2 = cos_normals * cos_normals;
    float c4 = c2 * c2;
    uvec2 light = texelFetch(source_illumination_, texel).xy;
    weight *= c4 * c4;
    sum.diffuse += weight * unpack_r11g11b10(light.x);
    sum.specular += weight * unpack_r11g11b10(light.y);
    sum.weight += weight;
}

// Four bilinear taps; where they fail, the nine pixels around with relaxed distances.
Gathered gather_around(CameraRecord source, uint page, vec2 p, Target target) {
    Gathered sum = Gathered(vec3(0.0), vec3(0.0), 0.0, kDiscardId);
    vec2 corner = floor(p - 0.5);
    vec2 f = p - 0.5 - corner;
    ivec2 base = ivec2(corner);
    gather(source, page, base, (1.0 - f.x) * (1.0 - f.y), target, 1.0, sum);
    gather(source, page, base + ivec2(1, 0), f.x * (1.0 - f.y), target, 1.0, sum);
    gather(source, page, base + ivec2(0, 1), (1.0 - f.x) * f.y, target, 1.0, sum);
    gather(source, page, base + ivec2(1, 1), f.x * f.y, target, 1.0, sum);
    if (sum.weight < params.settings.min_weight) {
        sum = Gathered(vec3(0.0), vec3(0.0), 0.0, sum.reason);
    }
    bool retry = sum.weight == 0.0;
    ivec2 nearest = ivec2(floor(p));
    for (int i = 0; retry && i < 9; ++i) { // a loop, so that no lane enters it where none has to
        ivec2 at = nearest + ivec2(i % 3 - 1, i / 3 - 1);
        vec2 d = vec2(at) + 0.5 - p;
        gather(source, page, at, exp(-dot(d, d)), target, 2.0, sum);
    }
    return sum;
}

Target make_target(Surface s, uint instance, vec3 direction, float footprint_m, float depth_m) {
    float facing = max(0.1, abs(dot(s.geometric_normal, direction)));
    return Target(s.position, s.geometric_normal, s.normal, (instance << 12) | s.material,
                  params.settings.plane_footprints * footprint_m + 1e-4 * depth_m,
                  params.settings.tangential_footprints * footprint_m / facing);
}

// Illumination of a surface in all sources that show it. If none does, `found` is false, and `reason` says which test
// failed.
struct Reused {
    vec3 diffuse;
    vec3 specular;
    bool found;
    uint reason;
};

// Share of the light that a glossy surface sends to `view` which it also sends to a source: the lobe that holds 75 % of
// GGX has a half angle of about 1.73 α. It is never 0, so that one source alone always counts.
float specular_confidence(Surface s, vec3 view, CameraRecord source) {
    float angle_squared = 2.0 * max(0.0, 1.0 - dot(view, normalize(source.origin - s.position)));
    float lobe = 1.73 * s.roughness * s.roughness + 1e-3;
    return exp(-angle_squared / (2.0 * lobe * lobe)) + 1e-6;
}

// Light that `s`, seen along `direction` with pixels of `footprint_m`, reflects: layer `layer` of every source, blended
// by the weight of the accepted pixels. The weight of specular light contains specular_confidence() as well.
Reused gather_sources(CameraBuffer cameras, uint layer, Surface s, uint instance, vec3 direction, float footprint_m,
                      float depth_m) {
    Reused sum = Reused(vec3(0.0), vec3(0.0), false, kDiscardFrustum);
    float diffuse_weight = 0.0;
    float specular_weight = 0.0;
    for (uint i = 0u; i < params.settings.source_count; ++i) {
        CameraRecord source = cameras.at[i];
        vec3 p = camera_project(source, s.position);
        vec2 size = vec2(camera_size(source));
        if (!(p.z > 0.0) || any(lessThan(p.xy, vec2(0.0))) || any(greaterThanEqual(p.xy, size))) {
            continue;
        }
        float footprint = max(p.z / source.focal_px, footprint_m);
        Target target = make_target(s, instance, direction, footprint, depth_m);
        Gathered one = gather_around(source, layer * params.settings.source_count + i, p.xy, target);
        sum.reason = max(sum.reason, one.reason);
        if (one.weight > 0.0) {
            float weight = min(one.weight, 1.0);
            float confidence = params.settings.source_count == 1u ? 1.0 : specular_confidence(s, -direction, source);
            sum.diffuse += one.diffuse * (weight / one.weight);
            sum.specular += one.specular * (weight * confidence / one.weight);
            diffuse_weight += weight;
            specular_weight += weight * confidence;
        }
    }
    sum.found = diffuse_weight > 0.0;
    if (sum.found) {
        sum.diffuse /= diffuse_weight;
        sum.specular /= specular_weight;
    }
    return sum;
}

#endif
