#version 460
// SPDX-License-Identifier: Apache-2.0
// Fills holes with the background: along the line on which surfaces move with their depth, the farther of the two
// surfaces beside the hole is continued into it, mirrored at its edge. Packs four pixels into three words of RGB8.
#extension GL_GOOGLE_include_directive : require
#include "lib/linear_index.glsl"
#include "lib/views.glsl"
#include "lib/warp_texels.glsl"

layout(local_size_x = kLinearGroup) in;
layout(push_constant, scalar) uniform Push { WarpViewsParams params; };
layout(set = 0, binding = kWarpTexels) uniform usamplerBuffer warp_texels_;

const float kSameSurface = 0.05; // of the inverse depth

struct Edge {
    bool is_found;
    ivec2 at;
    int steps;           // from the hole
    float inverse_depth;
};

uint pixel_index(uint view, ivec2 at) {
    return view * view_stride(params.width, params.height) + uint(at.y) * params.width + uint(at.x);
}

bool is_in_view(ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(params.width, params.height)));
}

bool is_hole(uint view, ivec2 at) {
    return (params.pixels.at[pixel_index(view, at)] & kWarpHole) != 0u;
}

ivec2 walked(ivec2 from, vec2 direction, int steps) {
    return ivec2(floor(vec2(from) + 0.5 + direction * float(steps)));
}

// The first pixel from `from` on that is no hole.
Edge find_edge(uint view, ivec2 from, vec2 direction) {
    int steps = 1;
    ivec2 at = walked(from, direction, steps);
    while (is_in_view(at) && is_hole(view, at)) {
        ++steps;
        at = walked(from, direction, steps);
    }
    bool is_found = is_in_view(at);
    return Edge(is_found, at, steps, is_found ? params.inverse_depth.at[pixel_index(view, at)] : 0.0);
}

// The farther of two edges; of two of the same surface the closer one.
Edge choose_edge(Edge a, Edge b) {
    if (!a.is_found || !b.is_found) {
        return a.is_found ? a : b;
    }
    float most = max(a.inverse_depth, b.inverse_depth);
    bool is_same = abs(a.inverse_depth - b.inverse_depth) <= kSameSurface * most;
    bool takes_a = is_same ? a.steps <= b.steps : a.inverse_depth < b.inverse_depth;
    return takes_a ? a : b;
}

// The pixel as far beyond the edge as the hole's pixel is before it, if it shows the same surface.
uint mirrored(uint view, ivec2 hole, Edge edge, vec2 direction) {
    bool is_forward = dot(vec2(edge.at - hole), direction) > 0.0;
    ivec2 at = walked(hole, is_forward ? direction : -direction, 2 * edge.steps - 1);
    if (is_in_view(at) && !is_hole(view, at)) {
        float inverse_depth = params.inverse_depth.at[pixel_index(view, at)];
        if (abs(inverse_depth - edge.inverse_depth) <= kSameSurface * edge.inverse_depth) {
            return params.pixels.at[pixel_index(view, at)];
        }
    }
    return params.pixels.at[pixel_index(view, edge.at)];
}

uint fill(uint view, ivec2 hole) {
    WarpPath path = params.paths.at[view * params.image_count];
    float longer = max(abs(path.parallax.x), abs(path.parallax.y));
    vec2 direction = longer > 0.0 ? path.parallax / longer : vec2(1.0, 0.0);
    for (int i = 0; i < 2; ++i) { // along the line, else across it
        Edge edge = choose_edge(find_edge(view, hole, direction), find_edge(view, hole, -direction));
        if (edge.is_found) {
            return mirrored(view, hole, edge, direction);
        }
        direction = vec2(-direction.y, direction.x);
    }
    WarpImage source = params.images.at[0];
    vec2 far = path.scale * (vec2(hole) + 0.5) + path.offset + source.least * path.parallax;
    ivec2 at = clamp(ivec2(floor(far)), ivec2(0), ivec2(source.width, source.height) - 1);
    return texelFetch(warp_texels_, int(source.first_texel) + at.y * int(source.width) + at.x).y;
}

uint finished(uint index) {
    uint stride = view_stride(params.width, params.height);
    ViewPixel pixel = locate_pixel(index, params.width, params.height);
    uint known = params.pixels.at[index];
    bool is_padding = index - pixel.view * stride >= params.width * params.height;
    return (is_padding || (known & kWarpHole) == 0u ? known : fill(pixel.view, ivec2(pixel.x, pixel.y))) & 0xFFFFFFu;
}

void main() {
    uint quad = linear_index();
    if (quad * 4u >= view_stride(params.width, params.height) * params.view_count) {
        return;
    }
    uint a = finished(quad * 4u);
    uint b = finished(quad * 4u + 1u);
    uint c = finished(quad * 4u + 2u);
    uint d = finished(quad * 4u + 3u);
    params.rgb8.at[quad * 3u] = a | (b << 24);
    params.rgb8.at[quad * 3u + 1u] = (b >> 8) | (c << 16);
    params.rgb8.at[quad * 3u + 2u] = (c >> 16) | (d << 8);
}
