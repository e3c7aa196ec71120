#version 460
// SPDX-License-Identifier: Apache-2.0
// G-buffer planes of the sources, every page, in wire precision, from its visibility.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/linear_index.glsl"
#include "lib/pages.glsl"
#include "lib/surface.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { SourceSurfacesParams params; };

void store(uint pixel, float depth, uint normal, uint id, uint material) {
    params.depth.at[pixel] = depth;
    params.normal.at[pixel] = normal;
    params.id.at[pixel] = id;
    params.material.at[pixel] = material;
    params.geometry.at[pixel] = uvec4(floatBitsToUint(depth), normal, id, material);
}

void main() {
    uint index = linear_index();
    if (index >= params.width * params.height * params.page_count) {
        return;
    }
    PagePixel at = locate_page_pixel(index, params.width, params.height);
    Visibility seen = page_visibility(params.visibility, params.layers, at.page, params.source_count,
                                      view_stride(params.width, params.height), at.pixel);
    if (seen.instance == kNoInstance) {
        store(index, uintBitsToFloat(0x7F800000u), 0u, kNoIndex, 0u);
        return;
    }
    CameraRecord camera = params.cameras.at[source_of_page(at.page, params.source_count)];
    vec3 direction = camera_direction(camera, vec2(at.x, at.y) + 0.5);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 meets = intersect_plane(triangle, camera.origin, direction);
    Surface s = make_surface(triangle, meets.xy, normalize(direction), meets.z / camera.focal_px);
    uint material = uint(s.roughness * 255.0 + 0.5) | (uint(s.metallic * 255.0 + 0.5) << 8);
    store(index, dot(s.position - camera.origin, camera.forward), pack_normal(s.normal),
          (seen.instance << 12) | s.material, material);
}
