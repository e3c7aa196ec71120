#version 460
// SPDX-License-Identifier: Apache-2.0
// Least squares fit of a block's accumulated illumination to features of its surfaces; one group per block.
// Follows: M. Koskela et al. Blockwise Multi-Order Feature Regression for Real-Time Path-Tracing Reconstruction. ACM
// Transactions on Graphics 38(5), 2019.
// Differs: normal equations and their Cholesky factors replace a QR factorisation, so that one pass over the pixels is
// enough. A ridge replaces the noise that is added to the features there, and is its expectation. Positions count from
// the middle of the block. Pixels without a surface do not take part, and blocks at the border are fitted to the
// nearest 32×32 pixels of the image instead of mirrored ones. There are two signals. Sums have a fixed order, whatever
// the size of a subgroup.
#extension GL_GOOGLE_include_directive : require
#include "shared/bmfr.h"

layout(local_size_x = kFitThreads) in;
layout(push_constant, scalar) uniform Push { BmfrParams params; };

#include "lib/block_fit.glsl"

const uint kPixelsPerThread = kFitSide * kFitSide / kFitThreads;
const uint kGram = kFitFeatures * (kFitFeatures + 1u) / 2u; // lower triangle, row by row
const uint kColumns = 6u;                                   // red, green, blue; diffuse, specular
const float kNoise = 1e-2;        // half width of the paper's uniform noise in the features
const float kThinnest = 1.0 / 64; // share of the largest extent; smaller extents count as this much
const float kFullTrust = 256.0;   // pixels: a quarter of a block

shared float partial_[kFitFeatures * kColumns * kFitThreads];
shared float gram_[kGram];
shared float right_[kFitFeatures * kColumns]; // right hand sides, then weights; features, then columns

struct BlockPixel {
    bool has_surface;
    int texel;
    vec3 normal;
    vec3 offset; // from the camera
};

ivec2 block_corner() {
    return params.first + ivec2(gl_WorkGroupID.xy * kFitSide);
}

BlockPixel load_pixel(CameraRecord camera, uint number) {
    uint index = gl_LocalInvocationID.x + kFitThreads * number;
    ivec2 inside = max(min(block_corner(), ivec2(params.width, params.height) - int(kFitSide)), ivec2(0));
    ivec2 at = inside + ivec2(index % kFitSide, index / kFitSide);
    BlockPixel pixel = BlockPixel(false, 0, vec3(0.0), vec3(0.0));
    if (is_inside(at)) {
        pixel.texel = int((gl_WorkGroupID.z * params.height + uint(at.y)) * params.width + uint(at.x));
        uvec4 geometry = texelFetch(geometry_, pixel.texel);
        pixel.has_surface = geometry.z != 0xFFFFFFFFu;
        pixel.normal = unpack_normal(geometry.y);
        pixel.offset = camera_offset(camera, at, geometry);
    }
    return pixel;
}

void put(uint slot, float value) {
    partial_[slot * kFitThreads + gl_LocalInvocationID.x] = value;
}

void put(uint slot, vec3 value) {
    put(slot, value.x);
    put(slot + 1u, value.y);
    put(slot + 2u, value.z);
}

// Sum over all invocations, in the same order on every device.
float sum_of(uint slot) {
    float sum = 0.0;
    for (uint i = 0u; i < kFitThreads; ++i) {
        sum += partial_[slot * kFitThreads + i];
    }
    return sum;
}

float least_of(uint slot) {
    float least = partial_[slot * kFitThreads];
    for (uint i = 1u; i < kFitThreads; ++i) {
        least = min(least, partial_[slot * kFitThreads + i]);
    }
    return least;
}

// Means and scale of the features, and the number of pixels that show a surface.
FitFrame measure_block(CameraRecord camera, out float count) {
    vec3 low = vec3(1e30);
    vec3 negative_high = vec3(1e30);
    vec3 normals = vec3(0.0);
    count = 0.0;
    for (uint i = 0u; i < kPixelsPerThread; ++i) {
        BlockPixel pixel = load_pixel(camera, i);
        if (pixel.has_surface) {
            low = min(low, pixel.offset);
            negative_high = min(negative_high, -pixel.offset);
            normals += pixel.normal;
            count += 1.0;
        }
    }
    put(0u, low);
    put(3u, negative_high);
    put(6u, normals);
    put(9u, count);
    barrier();
    low = vec3(least_of(0u), least_of(1u), least_of(2u));
    vec3 high = -vec3(least_of(3u), least_of(4u), least_of(5u));
    count = sum_of(9u);
    vec3 normal = vec3(sum_of(6u), sum_of(7u), sum_of(8u)) / max(count, 1.0);
    vec3 extent = max(high - low, vec3(0.0));
    float largest = max(max(extent.x, extent.y), extent.z);
    vec3 scale = 2.0 / max(extent, vec3(max(kThinnest * largest, 1e-20)));
    barrier();
    return FitFrame(normal, 0.5 * (low + high), scale);
}

// One invocation's share of the normal equations.
struct Products {
    float count;
    vec3 normal;
    vec3 position;
    vec3 square;
    mat3 normal_normal;
    mat3 position_normal; // rows: the first factor
    mat3 position_position;
    mat3 square_normal;
    mat3 square_position;
    mat3 square_square;
};

struct LightProducts {
    vec3 light;
    mat3 normal; // columns: the features
    mat3 position;
    mat3 square;
};

void add(inout Products p, Features f) {
    p.count += 1.0;
    p.normal += f.normal;
    p.position += f.position;
    p.square += f.square;
    p.normal_normal += outerProduct(f.normal, f.normal);
    p.position_normal += outerProduct(f.position, f.normal);
    p.position_position += outerProduct(f.position, f.position);
    p.square_normal += outerProduct(f.square, f.normal);
    p.square_position += outerProduct(f.square, f.position);
    p.square_square += outerProduct(f.square, f.square);
}

void add(inout LightProducts p, Features f, vec3 light) {
    p.light += light;
    p.normal += outerProduct(light, f.normal);
    p.position += outerProduct(light, f.position);
    p.square += outerProduct(light, f.square);
}

uint gram_index(uint row, uint column) {
    return row * (row + 1u) / 2u + column;
}

// Products of three features with three others at `row` and `column`; on the diagonal only the lower triangle.
void put_gram(uint row, uint column, mat3 products) {
    for (uint r = 0u; r < 3u; ++r) {
        for (uint c = 0u; c < 3u; ++c) {
            if (column + c <= row + r) {
                put(gram_index(row + r, column + c), products[c][r]);
            }
        }
    }
}

void put_products(Products p) {
    put(0u, p.count);
    for (uint i = 0u; i < 3u; ++i) {
        put(gram_index(1u + i, 0u), p.normal[i]);
        put(gram_index(4u + i, 0u), p.position[i]);
        put(gram_index(7u + i, 0u), p.square[i]);
    }
    put_gram(1u, 1u, p.normal_normal);
    put_gram(4u, 1u, p.position_normal);
    put_gram(4u, 4u, p.position_position);
    put_gram(7u, 1u, p.square_normal);
    put_gram(7u, 4u, p.square_position);
    put_gram(7u, 7u, p.square_square);
}

void put_light(uint column, LightProducts p) {
    put(column, p.light);
    for (uint i = 0u; i < 3u; ++i) {
        put((1u + i) * kColumns + column, p.normal[i]);
        put((4u + i) * kColumns + column, p.position[i]);
        put((7u + i) * kColumns + column, p.square[i]);
    }
}

void sum_products(CameraRecord camera, FitFrame frame) {
    const mat3 zero = mat3(0.0);
    const vec3 none = vec3(0.0);
    Products gram = Products(0.0, none, none, none, zero, zero, zero, zero, zero, zero);
    LightProducts diffuse = LightProducts(none, zero, zero, zero);
    LightProducts specular = LightProducts(none, zero, zero, zero);
    for (uint i = 0u; i < kPixelsPerThread; ++i) {
        BlockPixel pixel = load_pixel(camera, i);
        if (pixel.has_surface) {
            Features f = make_features(frame, pixel.offset, pixel.normal);
            add(gram, f);
            add(diffuse, f, texelFetch(diffuse_, pixel.texel).rgb);
            add(specular, f, texelFetch(specular_, pixel.texel).rgb);
        }
    }
    uint thread = gl_LocalInvocationID.x;
    put_products(gram);
    barrier();
    if (thread < kGram) {
        gram_[thread] = sum_of(thread);
    }
    barrier();
    put_light(0u, diffuse);
    put_light(3u, specular);
    barrier();
    if (thread < kFitFeatures * kColumns) {
        right_[thread] = sum_of(thread);
    }
    barrier();
}

// Computes the lower Cholesky factor of the products and the ridge, in place. The ridge is the expectation of what
// uniform noise adds to the squares: its variance, for each pixel. The constant has no noise.
void factorise(float count) {
    float ridge = count * kNoise * kNoise / 3.0;
    for (uint c = 0u; c < kFitFeatures; ++c) {
        float pivot = gram_[gram_index(c, c)] + (c > 0u ? ridge : 0.0);
        for (uint k = 0u; k < c; ++k) {
            pivot -= gram_[gram_index(c, k)] * gram_[gram_index(c, k)];
        }
        float diagonal = sqrt(max(pivot, 0.5 * ridge)); // without rounding, it is at least the ridge
        gram_[gram_index(c, c)] = diagonal;
        for (uint r = c + 1u; r < kFitFeatures; ++r) {
            float value = gram_[gram_index(r, c)];
            for (uint k = 0u; k < c; ++k) {
                value -= gram_[gram_index(r, k)] * gram_[gram_index(c, k)];
            }
            gram_[gram_index(r, c)] = value / diagonal;
        }
    }
}

// Forward and back substitution of one right hand side.
void substitute(uint column) {
    for (uint r = 0u; r < kFitFeatures; ++r) {
        float value = right_[r * kColumns + column];
        for (uint k = 0u; k < r; ++k) {
            value -= gram_[gram_index(r, k)] * right_[k * kColumns + column];
        }
        right_[r * kColumns + column] = value / gram_[gram_index(r, r)];
    }
    for (uint r = kFitFeatures; r-- > 0u;) {
        float value = right_[r * kColumns + column];
        for (uint k = r + 1u; k < kFitFeatures; ++k) {
            value -= gram_[gram_index(k, r)] * right_[k * kColumns + column];
        }
        right_[r * kColumns + column] = value / gram_[gram_index(r, r)];
    }
}

void solve(float count) {
    if (gl_LocalInvocationID.x == 0u) {
        factorise(count);
    }
    barrier();
    if (gl_LocalInvocationID.x < kColumns) {
        substitute(gl_LocalInvocationID.x);
    }
    barrier();
}

vec3 weight_of(uint feature, uint column) {
    uint at = feature * kColumns + column;
    return vec3(right_[at], right_[at + 1u], right_[at + 2u]);
}

void main() {
    CameraRecord camera = params.cameras.at[source_of_page(gl_WorkGroupID.z, params.source_count)];
    uint block = (gl_WorkGroupID.z * params.blocks.y + gl_WorkGroupID.y) * params.blocks.x + gl_WorkGroupID.x;
    uint thread = gl_LocalInvocationID.x;
    ivec2 corner = block_corner();
    if (any(lessThanEqual(corner, ivec2(-int(kFitSide)))) ||
        any(greaterThanEqual(corner, ivec2(params.width, params.height)))) {
        return; // outside the image
    }
    float count;
    FitFrame frame = measure_block(camera, count);
    if (2.0 * count <= kFullTrust) { // the same for all invocations
        if (thread == 0u) {
            params.fits.at[block].trust = 0.0;
        }
        return;
    }
    sum_products(camera, frame);
    solve(count);
    if (thread == 0u) {
        params.fits.at[block].normal = frame.normal;
        params.fits.at[block].centre = frame.centre;
        params.fits.at[block].scale = frame.scale;
        params.fits.at[block].trust = min(2.0 * count / kFullTrust - 1.0, 1.0);
    }
    if (thread < kFitFeatures) {
        params.fits.at[block].diffuse[thread] = weight_of(thread, 0u);
        params.fits.at[block].specular[thread] = weight_of(thread, 3u);
    }
}
