#version 460
// SPDX-License-Identifier: Apache-2.0
// G-buffer planes of the sources, every page, in wire precision, from its visibility.
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/geometry_texel.glsl"
#include "lib/linear_index.glsl"
#include "lib/pages.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { SourceSurfacesParams params; };

void store(uint pixel, uvec4 texel) {
    params.depth.at[pixel] = uintBitsToFloat(texel.x);
    params.normal.at[pixel] = texel.y;
    params.id.at[pixel] = texel.z;
    params.material.at[pixel] = texel.w;
    params.geometry.at[pixel] = texel;
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
        store(index, kNoSurface);
        return;
    }
    CameraRecord camera = params.cameras.at[source_of_page(at.page, params.source_count)];
    vec3 direction = camera_direction(camera, vec2(at.x, at.y) + 0.5);
    WorldTriangle triangle = load_world_triangle(seen.instance, seen.primitive);
    vec3 meets = intersect_plane(triangle, camera.origin, direction);
    Surface s = make_surface(triangle, meets.xy, normalize(direction), meets.z / camera.focal_px);
    params.flags.at[index / kLinearGroup] = 1u;
    params.tile_flags.at[tile_of(at, params.width, params.height)] = 1u;
    store(index, geometry_texel(s, seen.instance, dot(s.position - camera.origin, camera.forward)));
}
