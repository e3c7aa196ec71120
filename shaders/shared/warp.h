// SPDX-License-Identifier: Apache-2.0
// Views made from images with depth alone (core/render/warp/warp_renderer.h).
#ifndef FIELDCAST_SHARED_WARP_H
#define FIELDCAST_SHARED_WARP_H
#include "types.h"

SHARED_BEGIN

// An image that views are made from, as texels: inverse depth (bits of a float, negative: nothing is known there), then
// colour (red in the low byte) and kLink….
struct WarpImage {
    uint first_texel;
    uint width;
    uint height;
    uint first_block;   // of the bounds of its blocks, row by row
    uint first_coarse;  // … of its coarse blocks
    float least;        // inverse depth, 1/m
    float most;
};
SHARED_BUFFER(WarpImageBuffer, WarpImage);

// A texel shows the same surface as its neighbour …
const uint kLinkRight = 1u << 24;
const uint kLinkBelow = 2u << 24;
const uint kLinkBelowRight = 4u << 24;
const uint kLinkBelowLeft = 8u << 24;

// Blocks hold the least and most inverse depth of their texels and of one texel around them.
const uint kWarpBlock = 8;        // texels on a side
const uint kWarpCoarseBlock = 32;

// Place in an image of the point that target pixel x sees at inverse depth w: scale · x + offset + w · parallax.
struct WarpPath {
    vec2 offset;   // pixels of the image
    vec2 parallax; // pixels · metres
    float scale;
};
SHARED_BUFFER(WarpPathBuffer, WarpPath);

// warp_unpack.comp: wire planes into texels without links.
struct WarpUnpackParams {
    WarpImageBuffer images;
    UintBuffer colour;        // RGB8
    UintBuffer inverse_depth; // R16
    UintBuffer tiles;         // numbers (core/lightfield/residual_layer.h)
    Uvec2Buffer texels;       // out
    uint width;               // of the planes
    uint height;
    uint tile_count;          // 0: the planes are image 0; else they hold tiles of the images from 1 on
    float unit;               // of inverse depth, 1/m
};

// warp_link.comp: adds kLink… to the texels of every image.
struct WarpLinkParams {
    WarpImageBuffer images;
    Uvec2Buffer texels; // in/out
    float unit;
};

// warp_bounds.comp: computes the bounds of blocks, then those of coarse blocks.
struct WarpBoundsParams {
    WarpImageBuffer images;
    Uvec2Buffer texels;
    Vec2Buffer blocks; // out, or in with is_coarse
    Vec2Buffer coarse; // out with is_coarse
    uint is_coarse;
};

// State of a view's pixel, in the high byte of its word; the other bytes hold its colour.
const uint kWarpFromSource = 0;
const uint kWarpFromResidual = 1u << 24;
const uint kWarpHole = 2u << 24;

// Counters of each view.
const uint kWarpCountResidual = 0; // pixels from the residual layer
const uint kWarpCountOutside = 1;  // holes that lie outside the source
const uint kWarpCountHidden = 2;   // other holes
const uint kWarpCounters = 4;

// warp_views.comp: searches every pixel of every view in the images. warp_fill.comp: extends the background into the
// holes and packs the views. Both read set 0: kWarp….
struct WarpViewsParams {
    WarpImageBuffer images;
    WarpPathBuffer paths;     // view · image_count + image
    UintBuffer pixels;        // views have lib/views.glsl's view_stride()
    FloatBuffer inverse_depth;
    UintBuffer counters;
    UintBuffer rgb8;          // out of warp_fill.comp
    uint width;
    uint height;
    uint view_count;
    uint image_count;
};
const uint kWarpTexels = 0; // RG32UI
const uint kWarpBlocks = 1; // RG32F
const uint kWarpCoarse = 2; // RG32F

SHARED_END
#endif
