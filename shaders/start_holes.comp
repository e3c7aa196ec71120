#version 460
// SPDX-License-Identifier: Apache-2.0
// Stores the surfaces of holes, and fills holes without rays where possible. It takes the hole's own light of the
// previous frame, and for isolated holes the light of the same surface around their place in the source. Lists the
// others.
#extension GL_GOOGLE_include_directive : require
#include "shared/holes.h"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { HoleParams params; };

#include "lib/holes.glsl"

const float kSettledFrames = 4.0; // from then on a hole is traced in every fourth frame only
const uint kIsolatedCount = 3u;   // largest number of holes in a tile of 32 pixels that counts as isolated

// Place and plane of the surface point in the previous frame.
Target past_target(Target now, Visibility seen, vec3 weights, uvec3 vertices, CameraRecord before) {
    mat4x3 m = load_previous_transform(seen.instance);
    vec3 corner0 = load_vertex(vertices.x).xyz;
    vec3 corner1 = load_vertex(vertices.y).xyz;
    vec3 corner2 = load_vertex(vertices.z).xyz;
    Target past = now;
    past.position = m * vec4(corner0 * weights.x + corner1 * weights.y + corner2 * weights.z, 1.0);
    vec3 normal = cross(m * vec4(corner1 - corner0, 0.0), m * vec4(corner2 - corner0, 0.0));
    past.geometric_normal = normal / max(length(normal), 1e-30);
    return past;
}

HoleSum remember(uint view, Target target, Visibility seen, vec3 weights, uvec3 vertices) {
    HoleFrame frame = params.frames.at[1];
    CameraRecord before = frame.cameras.at[kMaxSources + view];
    Target past = past_target(target, seen, weights, vertices, before);
    vec3 p = camera_project(before, past.position);
    HoleSum sum = HoleSum(vec3(0.0), vec3(0.0), 0.0, 0.0);
    if (p.z > 0.0) {
        gather_holes_around(frame, view, before, p.xy, past, sum);
    }
    return sum;
}

bool is_isolated(uint view, uvec2 at) {
    uint word = params.frames.at[0].words.at[hole_bit(view, at, params.width, params.height).word];
    return uint(bitCount(word)) <= kIsolatedCount;
}

// Light of the same surface within three pixels of the hole's place in the sources.
Gathered gather_wide(Target target) {
    Gathered sum = Gathered(vec3(0.0), vec3(0.0), 0.0, kDiscardId);
    for (uint source = 0u; source < params.settings.source_count; ++source) {
        CameraRecord camera = params.frames.at[0].cameras.at[source];
        vec3 p = camera_project(camera, target.position);
        ivec2 nearest = ivec2(floor(p.xy));
        for (int i = 0; p.z > 0.0 && i < 49; ++i) {
            ivec2 at = nearest + ivec2(i % 7 - 3, i / 7 - 3);
            vec2 d = vec2(at) + 0.5 - p.xy;
            gather(camera, source, at, exp(-0.5 * dot(d, d)), target, 3.0, sum);
        }
    }
    return sum;
}

void list_hole(uint number, uint view) {
    bool is_first = (params.stages & kHolesCascade) == 0u || params.views.at[view].is_corner != 0u;
    uint counter = is_first ? kCounterFirstHoles : kCounterInnerHoles;
    uint slot = atomicAdd(params.counters.at[counter], 1u);
    params.lists.at[(is_first ? 0u : params.hole_count) + slot] = number;
}

// The pixel's surface: barycentrics and view depth of its point, its triangle, and its stored form.
struct HoleSurface {
    vec3 at; // barycentrics of the second and third vertex, view depth
    uvec3 vertices;
    uvec4 stored;
};

HoleSurface find_surface(Visibility seen, CameraRecord camera, vec2 position) {
    vec3 direction = camera_direction(camera, position);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 at = intersect_plane(triangle, camera.origin, direction);
    Surface s = make_surface(triangle, at.xy, normalize(direction), at.z / camera.focal_px);
    uvec4 stored = uvec4(floatBitsToUint(at.z), pack_normal(s.normal), pack_normal(s.geometric_normal),
                         (seen.instance << 12) | s.material);
    return HoleSurface(at, triangle.vertices, stored);
}

// The hole's own light of the frame before; none without a hole of the same surface there.
HoleLight remembered_light(uint view, Target target, Visibility seen, HoleSurface surface) {
    if ((params.stages & kHolesPreviousFrame) != 0u) {
        vec3 weights = vec3(1.0 - surface.at.x - surface.at.y, surface.at.xy);
        HoleSum past = remember(view, target, seen, weights, surface.vertices);
        if (past.weight >= params.settings.min_weight) {
            return mean_light(past);
        }
    }
    return HoleLight(vec3(0.0), vec3(0.0), 0.0);
}

// Whether a hole needs no rays in this frame. `light` becomes the light that it then shows.
bool fill_without_rays(ViewPixel pixel, Target target, inout HoleLight light) {
    bool is_its_turn = ((pixel.x + 2u * pixel.y + params.noise_frame) & 3u) == 0u;
    if (light.frames >= kSettledFrames && !is_its_turn) {
        atomicAdd(params.counters.at[kCounterRememberedHoles], 1u);
        return true;
    }
    if ((params.stages & kHolesIsolated) == 0u || !is_isolated(pixel.view, uvec2(pixel.x, pixel.y))) {
        return false;
    }
    Gathered around = gather_wide(target);
    if (around.weight < 0.25) {
        return false;
    }
    light = HoleLight(around.diffuse / around.weight, around.specular / around.weight, 1.0);
    atomicAdd(params.counters.at[kCounterIsolatedHoles], 1u);
    return true;
}

void main() {
    uint number = linear_index();
    if (number >= params.hole_count) {
        return;
    }
    HoleFrame frame = params.frames.at[0];
    uint index = frame.pixels.at[number];
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    CameraRecord camera = frame.cameras.at[kMaxSources + pixel.view];
    vec2 position = vec2(pixel.x, pixel.y) + 0.5;
    Visibility seen = params.visibility.at[index];
    HoleSurface surface = find_surface(seen, camera, position);
    frame.surfaces.at[number] = surface.stored;

    Target target = stored_target(surface.stored, camera, position);
    HoleLight light = remembered_light(pixel.view, target, seen, surface);
    bool is_filled = fill_without_rays(pixel, target, light);
    frame.light.at[number] = pack_hole_light(light);
    if (!is_filled) {
        list_hole(number, pixel.view);
    }
}
