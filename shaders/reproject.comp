#version 460
// SPDX-License-Identifier: Apache-2.0
// Backward reprojection of the source's illumination into every pixel of every view, remodulated with the view's own
// material. What cannot be reused goes to the hole list.
// Follows: M. Mäkitalo et al. Real-Time Light Field Path Tracing. CGI 2022, section 3.2.
// Differs: illumination instead of radiance; thresholds follow the pixel footprint, so no constants per scene; sky and
// emission are exact.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/lights.glsl"
#include "lib/views.glsl"

layout(local_size_x = 64) in;
layout(constant_id = kSpecialiseBlend) const bool kHasBlend = false;
layout(set = 1, binding = kReprojectGeometry) uniform usamplerBuffer source_geometry_;
layout(set = 1, binding = kReprojectIllumination) uniform usamplerBuffer source_illumination_;
layout(push_constant, scalar) uniform Push { ReprojectParams params; };

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
void gather(CameraRecord source, ivec2 size, ivec2 at, float weight, Target target, float slack, inout Gathered sum) {
    if (weight <= 0.0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) {
        return;
    }
    int texel = at.y * size.x + at.x;
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
Gathered gather_around(CameraRecord source, vec2 p, Target target) {
    Gathered sum = Gathered(vec3(0.0), vec3(0.0), 0.0, kDiscardId);
    ivec2 size = ivec2(camera_size(source));
    vec2 corner = floor(p - 0.5);
    vec2 f = p - 0.5 - corner;
    ivec2 base = ivec2(corner);
    gather(source, size, base, (1.0 - f.x) * (1.0 - f.y), target, 1.0, sum);
    gather(source, size, base + ivec2(1, 0), f.x * (1.0 - f.y), target, 1.0, sum);
    gather(source, size, base + ivec2(0, 1), (1.0 - f.x) * f.y, target, 1.0, sum);
    gather(source, size, base + ivec2(1, 1), f.x * f.y, target, 1.0, sum);
    if (sum.weight < params.settings.min_weight) {
        sum = Gathered(vec3(0.0), vec3(0.0), 0.0, sum.reason);
    }
    bool retry = sum.weight == 0.0;
    ivec2 nearest = ivec2(floor(p));
    for (int i = 0; retry && i < 9; ++i) { // a loop, so that no lane enters it where none has to
        ivec2 at = nearest + ivec2(i % 3 - 1, i / 3 - 1);
        vec2 d = vec2(at) + 0.5 - p;
        gather(source, size, at, exp(-dot(d, d)), target, 2.0, sum);
    }
    return sum;
}

Target make_target(Surface s, uint instance, vec3 direction, float footprint_m, float depth_m) {
    float facing = max(0.1, abs(dot(s.geometric_normal, direction)));
    return Target(s.position, s.geometric_normal, s.normal, (instance << 12) | s.material,
                  params.settings.plane_footprints * footprint_m + 1e-4 * depth_m,
                  params.settings.tangential_footprints * footprint_m / facing);
}

void discard_pixel(uint view, uint pixel, uint reason) {
    atomicAdd(params.counters.at[kCounterDiscards + view * 4u + reason], 1u);
    uint slot = atomicAdd(params.counters.at[kCounterHoles], 1u);
    params.holes.at[slot] = pixel;
}

// Radiance of a pixel that sees a surface; false: it has to be traced.
bool reproject(uint view, uint pixel, Visibility seen, CameraRecord camera, vec2 position, out vec3 radiance) {
    vec3 direction = camera_direction(camera, position);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(triangle, camera.origin, direction);
    direction = normalize(direction);
    Surface s = make_surface(triangle, at.xy, direction, at.z / camera.focal_px);
    CameraRecord source = params.cameras.at[0];
    vec3 p = camera_project(source, s.position);
    vec2 size = vec2(camera_size(source));
    radiance = vec3(0.0);
    if (!(p.z > 0.0) || any(lessThan(p.xy, vec2(0.0))) || any(greaterThanEqual(p.xy, size))) {
        discard_pixel(view, pixel, kDiscardFrustum);
        return false;
    }
    float footprint = max(p.z / source.focal_px, at.z / camera.focal_px);
    Gathered sum = gather_around(source, p.xy, make_target(s, seen.instance, direction, footprint, at.z));
    if (sum.weight == 0.0) {
        discard_pixel(view, pixel, sum.reason);
        return false;
    }
    vec3 modulation = specular_modulation(make_bsdf(s, direction));
    radiance = s.emission + (sum.diffuse * s.diffuse_colour + sum.specular * modulation) / sum.weight;
    return true;
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= params.width) {
        return;
    }
    uint pixel = id.z * view_stride(params.width, params.height) + id.y * params.width + id.x;
    CameraRecord camera = params.cameras.at[id.z + 1u];
    vec2 position = vec2(id.xy) + 0.5;
    Visibility seen = params.visibility.at[pixel];
    vec3 radiance;
    if (seen.instance == kNoInstance) {
        radiance = environment_radiance(load_scene_info(), normalize(camera_direction(camera, position)));
        params.radiance.at[pixel] = pack_half3(radiance);
    } else if (reproject(id.z, pixel, seen, camera, position, radiance)) {
        params.radiance.at[pixel] = pack_half3(radiance);
    }
    if (kHasBlend && params.layers.at[pixel * 2u].instance != kNoInstance) {
        uint slot = atomicAdd(params.counters.at[kCounterLayers], 1u);
        params.layer_pixels.at[slot] = pixel;
    }
}
