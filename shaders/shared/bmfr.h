// SPDX-License-Identifier: Apache-2.0
// Blockwise fits of illumination to features of the surfaces (core/render/denoise/bmfr.h).
#ifndef FIELDCAST_SHARED_BMFR_H
#define FIELDCAST_SHARED_BMFR_H
#include "frame.h"

SHARED_BEGIN

const uint kFitSide = 32;     // pixels of a block in each direction
const uint kFitThreads = 64;  // invocations per block
const uint kFitFeatures = 10; // 1, n, q, q²: see BlockFit

// Illumination of one block: Σ weight · feature. With n the shading normal less its mean, and
// q = (position − camera's origin − centre) · scale, component by component.
struct BlockFit {
    vec3 normal;  // mean over the block
    vec3 centre;  // metres
    vec3 scale;   // brings the block's positions to −1 … 1
    float trust;  // 0: too few pixels show a surface for a fit; 1: enough
    vec3 diffuse[kFitFeatures];
    vec3 specular[kFitFeatures];
};
SHARED_BUFFER(BlockFitBuffer, BlockFit);

// bmfr_fit.comp: one group per block; bmfr_evaluate.comp: every pixel. Read kFilter… and kBmfr….
struct BmfrParams {
    CameraBuffer cameras;    // one per source
    BlockFitBuffer fits;    // bmfr_fit.comp: out; blocks of a row, rows, pages
    HistoryTapsBuffer taps;
    Vec4Buffer diffuse;     // out, of bmfr_evaluate.comp: rgb
    Vec4Buffer specular;
    UintBuffer groups;      // of bmfr_evaluate.comp, to run on
    uint width;
    uint height;
    uint page_count;
    uint source_count;
    uvec2 blocks;           // columns, rows
    ivec2 first;            // pixel in which the first block begins, ≤ 0
    uint flags;             // kFlagTemporal: `taps` lead to a filtered frame
    float sigma_depth;      // of the weights of a pixel's surroundings, as in FilterParams
    uint normal_squarings;
    float alpha;            // least weight of a frame in the result
};
const uint kBmfrPreviousDiffuse = 5; // after kFilter…: filtered, rgb
const uint kBmfrPreviousSpecular = 6;

SHARED_END
#endif
