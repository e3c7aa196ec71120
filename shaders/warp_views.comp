#version 460
// SPDX-License-Identifier: Apache-2.0
// Finds the surface that every pixel of every view sees, in the source or else in the residual layer.
#extension GL_GOOGLE_include_directive : require
#include "lib/views.glsl"
#include "lib/warp_search.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { WarpViewsParams params; };

// A surface in the residual layer must be nearer than the source's surface by this factor to count as in front of it.
const float kNearer = 1.02;

void count(uint view, uint what) {
    atomicAdd(params.counters.at[view * kWarpCounters + what], 1u);
}

// Whether even the farthest point that the pixel may see lies beyond the border of the source.
bool is_outside(WarpImage source, WarpPath path, vec2 pixel) {
    vec2 far = path.scale * pixel + path.offset + source.least * path.parallax;
    return any(lessThan(far, vec2(0.0))) || any(greaterThanEqual(far, vec2(source.width, source.height)));
}

// The nearest surface that any image shows, and the number of that image.
WarpHit search_images(uint view, vec2 pixel, out uint shown) {
    WarpHit best = WarpHit(false, false, vec2(0.0), 0.0);
    shown = 0u;
    for (uint i = 0u; i < params.image_count; ++i) {
        float least = best.is_found ? best.inverse_depth * kNearer : 0.0;
        WarpHit hit = search_image(params.images.at[i], params.paths.at[view * params.image_count + i], pixel, least);
        bool is_in_front = !hit.is_edge && hit.inverse_depth > least;
        if (hit.is_found && (!best.is_found || is_in_front)) {
            best = hit;
            shown = i;
        }
    }
    return best;
}

void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x >= params.width || id.y >= params.height) {
        return;
    }
    vec2 pixel = vec2(id.xy) + 0.5;
    uint shown;
    WarpHit best = search_images(id.z, pixel, shown);
    uint at = id.z * view_stride(params.width, params.height) + id.y * params.width + id.x;
    params.inverse_depth.at[at] = best.inverse_depth;
    if (best.is_found) {
        uint origin = shown == 0u ? kWarpFromSource : kWarpFromResidual;
        params.pixels.at[at] = pack_colour(colour_at(params.images.at[shown], best.at)) | origin;
        if (shown > 0u) {
            count(id.z, kWarpCountResidual);
        }
        return;
    }
    params.pixels.at[at] = kWarpHole;
    bool outside = is_outside(params.images.at[0], params.paths.at[id.z * params.image_count], pixel);
    count(id.z, outside ? kWarpCountOutside : kWarpCountHidden);
}
