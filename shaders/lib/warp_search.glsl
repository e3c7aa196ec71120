// SPDX-License-Identifier: Apache-2.0
// The nearest surface of an image that a pixel of another view sees. All points that the pixel may see lie on a
// straight line in the image, at distances proportional to their inverse depth. The search follows the line from the
// near end, one texel of its longer axis at a time, until it reaches the surface.
// Follows: H. Bowles et al. Iterative Image Warping. Eurographics 2012, section 3, for the problem.
// Differs: no fixed-point iteration but a search of the whole line, over bounds of blocks, which misses nothing.
// The including kernel binds set 0.
#ifndef FIELDCAST_LIB_WARP_SEARCH
#define FIELDCAST_LIB_WARP_SEARCH
#include "lib/warp_texels.glsl"

layout(set = 0, binding = kWarpTexels) uniform usamplerBuffer warp_texels_;
layout(set = 0, binding = kWarpBlocks) uniform samplerBuffer warp_blocks_;
layout(set = 0, binding = kWarpCoarse) uniform samplerBuffer warp_coarse_;

struct WarpHit {
    bool is_found;
    bool is_edge;        // only within half a texel of an edge
    vec2 at;             // position in the image
    float inverse_depth;
};

// The line of one target pixel. `along` is the longer axis; positions on it are texel centres, k + 0.5.
struct WarpLine {
    vec2 origin;    // infinitely far points
    float parallax; // along the axis, as an amount
    float slope;    // of the other axis
    int axis;       // 0: x, 1: y
    float side;     // 1: near points have larger coordinates, -1: smaller
};

// Sample of the image on the line.
struct WarpSample {
    float inverse_depth; // negative: nothing
    float gap;           // pixels by which the surface lies in front of the ray there
    ivec2 texel;         // the nearest one
    uint word;           // its colour and links
};

WarpLine make_line(WarpPath path, vec2 pixel) {
    bool is_x = abs(path.parallax.x) >= abs(path.parallax.y);
    vec2 d = is_x ? path.parallax : path.parallax.yx;
    return WarpLine(path.scale * pixel + path.offset, abs(d.x), d.x == 0.0 ? 0.0 : d.y / d.x, is_x ? 0 : 1,
                    d.x >= 0.0 ? 1.0 : -1.0);
}

// Position of coordinate `along` of the axis.
vec2 line_position(WarpLine line, float along) {
    float offset = along - line.origin[line.axis];
    return line.axis == 0 ? vec2(along, line.origin.y + line.slope * offset)
                          : vec2(line.origin.x + line.slope * offset, along);
}

uvec2 fetch_texel(WarpImage image, ivec2 at) {
    return texelFetch(warp_texels_, int(image.first_texel) + at.y * int(image.width) + at.x).xy;
}

WarpSample sample_line(WarpImage image, WarpLine line, int k) {
    float along = float(k) + 0.5;
    vec2 p = line_position(line, along);
    ivec2 nearest = ivec2(floor(p));
    if (any(lessThan(nearest, ivec2(0))) || any(greaterThanEqual(nearest, ivec2(image.width, image.height)))) {
        return WarpSample(-1.0, 0.0, nearest, 0u);
    }
    uvec2 texel = fetch_texel(image, nearest);
    float depth = uintBitsToFloat(texel.x);
    int across = 1 - line.axis;
    float offset = p[across] - float(nearest[across]) - 0.5; // −0.5 to 0.5 beside the nearest texel
    ivec2 other = nearest;
    other[across] += offset < 0.0 ? -1 : 1;
    int extent = int(across == 0 ? image.width : image.height);
    bool has_other = abs(offset) > 0.01 && other[across] >= 0 && other[across] < extent;
    if (has_other && depth >= 0.0) {
        uvec2 beside = fetch_texel(image, other);
        if (is_linked(nearest, texel.y, other, beside.y)) {
            depth = mix(depth, uintBitsToFloat(beside.x), abs(offset));
        }
    }
    float gap = line.parallax * depth - line.side * (along - line.origin[line.axis]);
    return WarpSample(depth, gap, nearest, texel.y);
}

// Coordinate up to which the block at `k` can be passed over; `k` itself if the ray may meet the surface in the block.
int end_of_empty_block(WarpImage image, WarpLine line, int k, int step, bool is_coarse) {
    int side = int(is_coarse ? kWarpCoarseBlock : kWarpBlock);
    vec2 p = line_position(line, float(k) + 0.5);
    ivec2 block = ivec2(floor(p)) / side;
    int across = 1 - line.axis;
    int end = step < 0 ? block[line.axis] * side - 1 : (block[line.axis] + 1) * side;
    float drift = line.slope * float(step);
    if (drift != 0.0) {
        float edge = float((block[across] + (drift > 0.0 ? 1 : 0)) * side);
        int inside = max(int(ceil((edge - p[across]) / drift)), 1); // steps until the line leaves the block
        end = step < 0 ? max(end, k - inside) : min(end, k + inside);
    }
    int columns = (int(image.width) + side - 1) / side;
    int at = block.y * columns + block.x;
    vec2 bounds = is_coarse ? texelFetch(warp_coarse_, int(image.first_coarse) + at).xy
                            : texelFetch(warp_blocks_, int(image.first_block) + at).xy;
    float first_ray = line.side * (float(k) + 0.5 - line.origin[line.axis]) + 1.0; // and one texel around
    float last_ray = line.side * (float(end - step) + 0.5 - line.origin[line.axis]) - 1.0;
    bool is_empty = line.parallax * bounds.y - last_ray < -0.5 || line.parallax * bounds.x - first_ray > 0.5;
    return is_empty ? end : k;
}

// Meeting point of the ray and the surface between two neighbouring samples, the first one nearer: between linked
// samples, or within half a texel of a sample at the edge of its surface.
WarpHit meet(WarpLine line, WarpSample a, int k_a, WarpSample b, int k_b) {
    bool has_a = a.inverse_depth >= 0.0;
    bool has_b = b.inverse_depth >= 0.0;
    if (has_a && has_b && is_linked(a.texel, a.word, b.texel, b.word)) {
        float span = b.gap - a.gap;
        float t = span > 0.0 ? -a.gap / span : 0.0;
        bool is_found = a.gap <= 0.0 && b.gap >= 0.0;
        return WarpHit(is_found, false, line_position(line, mix(float(k_a), float(k_b), t) + 0.5),
                       mix(a.inverse_depth, b.inverse_depth, t));
    }
    bool meets_a = has_a && a.gap <= 0.0 && a.gap >= -0.5;
    bool meets_b = has_b && b.gap >= 0.0 && b.gap <= 0.5;
    bool is_a = meets_a && (!meets_b || a.inverse_depth >= b.inverse_depth);
    float along = is_a ? float(k_a) + 0.5 + line.side * a.gap : float(k_b) + 0.5 + line.side * b.gap;
    return WarpHit(meets_a || meets_b, true, line_position(line, along), is_a ? a.inverse_depth : b.inverse_depth);
}

// Ignores surfaces farther than inverse depth `least`.
WarpHit search_image(WarpImage image, WarpPath path, vec2 pixel, float least) {
    if (image.most < least) {
        return WarpHit(false, false, vec2(0.0), 0.0);
    }
    WarpLine line = make_line(path, pixel);
    int step = line.side > 0.0 ? -1 : 1;
    float near = line.origin[line.axis] + line.side * line.parallax * image.most - 0.5;
    float far = line.origin[line.axis] + line.side * line.parallax * max(image.least, least) - 0.5;
    int last = int(line.axis == 0 ? image.width : image.height) - 1;
    int k = clamp((step < 0 ? int(ceil(near)) : int(floor(near))) - step, 0, last);
    int end = clamp((step < 0 ? int(floor(far)) : int(ceil(far))) + step, 0, last) + step;
    WarpSample before = WarpSample(-1.0, 0.0, ivec2(0), 0u);
    ivec2 extent = ivec2(image.width, image.height);
    while ((end - k) * step > 0) {
        ivec2 texel = ivec2(floor(line_position(line, float(k) + 0.5)));
        bool is_inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, extent));
        bool starts_block = ((step < 0 ? k + 1 : k) & int(kWarpBlock - 1u)) == 0 || before.inverse_depth < 0.0;
        if (is_inside && starts_block) {
            int next = end_of_empty_block(image, line, k, step, true);
            next = next == k ? end_of_empty_block(image, line, k, step, false) : next;
            if (next != k) {
                before = WarpSample(-1.0, 0.0, ivec2(0), 0u);
                k = next;
                continue;
            }
        }
        WarpSample now = sample_line(image, line, k);
        WarpHit hit = meet(line, before, k - step, now, k);
        if (hit.is_found) {
            return hit;
        }
        before = now;
        k += step;
    }
    return meet(line, before, k - step, WarpSample(-1.0, 0.0, ivec2(0), 0u), k);
}

// E. Catmull, R. Rom. A class of local interpolating splines. 1974: weights of four values, `f` beyond the second.
vec4 catmull_rom(float f) {
    float f2 = f * f;
    float f3 = f2 * f;
    return 0.5 * vec4(2.0 * f2 - f3 - f, 3.0 * f3 - 5.0 * f2 + 2.0, 4.0 * f2 - 3.0 * f3 + f, f3 - f2);
}

// Sharper than a bilinear colour; `is_smooth` false: the 4×4 texels around do not all show one surface.
vec3 sharp_colour(WarpImage image, ivec2 corner, vec2 f, out bool is_smooth) {
    ivec2 first = corner - 1;
    is_smooth = all(greaterThanEqual(first, ivec2(0))) && all(lessThan(first + 3, ivec2(image.width, image.height)));
    vec4 across = catmull_rom(f.x);
    vec4 down = catmull_rom(f.y);
    vec3 sum = vec3(0.0);
    for (int y = 0; is_smooth && y < 4; ++y) {
        vec3 row = vec3(0.0);
        for (int x = 0; x < 4; ++x) {
            uint word = fetch_texel(image, first + ivec2(x, y)).y;
            bool is_linked_right = x == 3 || (word & kLinkRight) != 0u;
            bool is_linked_below = x != 1 || y == 3 || (word & kLinkBelow) != 0u;
            is_smooth = is_smooth && is_linked_right && is_linked_below;
            row += across[x] * texel_colour(word);
        }
        sum += down[y] * row;
    }
    return sum;
}

// Colour at a hit, from the texels around that show the same surface.
vec3 colour_at(WarpImage image, vec2 p) {
    bool is_smooth;
    vec3 sharp = sharp_colour(image, ivec2(floor(p - 0.5)), fract(p - 0.5), is_smooth);
    if (is_smooth) {
        return sharp;
    }
    ivec2 extent = ivec2(image.width, image.height);
    ivec2 nearest = clamp(ivec2(floor(p)), ivec2(0), extent - 1);
    uint word = fetch_texel(image, nearest).y;
    vec2 corner = floor(p - 0.5);
    vec2 f = p - 0.5 - corner;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 tap = ivec2(i & 1, i >> 1);
        ivec2 at = ivec2(corner) + tap;
        float weight = (tap.x == 1 ? f.x : 1.0 - f.x) * (tap.y == 1 ? f.y : 1.0 - f.y);
        if (weight > 0.0 && all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, extent))) {
            uint other = fetch_texel(image, at).y;
            bool is_same = at == nearest || is_linked(nearest, word, at, other);
            sum += is_same ? weight * vec4(texel_colour(other), 1.0) : vec4(0.0);
        }
    }
    return sum.w > 0.0 ? sum.rgb / sum.w : texel_colour(word);
}

#endif
