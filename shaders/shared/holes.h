// SPDX-License-Identifier: Apache-2.0
// Holes: pixels of target views that no source pixel could be reused for. A map says which pixels are holes and which
// place each has in the arrays that hold only holes.
#ifndef FIELDCAST_SHARED_HOLES_H
#define FIELDCAST_SHARED_HOLES_H
#include "frame.h"

SHARED_BEGIN

// One word of the map per tile of a view, one bit per pixel: bit (y % 4) · 8 + x % 8.
const uint kHoleTileWidth = 8;
const uint kHoleTileHeight = 4;
const uint kHoleBlock = 64; // words that one invocation counts

// Data of the holes of one frame. Arrays are in the order of the map's bits.
struct HoleFrame {
    CameraBuffer cameras; // kMaxSources, then the views
    UintBuffer words;     // the map
    UintBuffer first;     // number of the first hole of each word
    UintBuffer pixels;    // index over all views
    Uvec4Buffer surfaces; // view depth (bits), packed shading normal, packed geometric normal, id
    Uvec4Buffer light;    // packed HoleLight (lib/holes.glsl): illumination before the filter
};
SHARED_BUFFER(HoleFrameBuffer, HoleFrame);

// count_holes.comp, scan_holes.comp, list_holes.comp: they derive the order of the arrays from the map's words.
struct HoleMapParams {
    UintBuffer words;
    UintBuffer first;  // out
    UintBuffer blocks; // holes of each block of words; scan_holes.comp turns them into numbers of first holes
    UintBuffer pixels; // out
    UintBuffer counters;
    uint word_count;
    uint block_count;
    uint width;
    uint height;
};

const uint kHolesPreviousFrame = 1; // HoleParams::stages
const uint kHolesIsolated = 2;
const uint kHolesEndInSource = 4;
const uint kHolesCascade = 8;
const uint kNoCornerView = 0xFF;

// start_holes.comp, trace_holes.comp, cascade_holes.comp, filter_holes.comp, shade_holes.comp. They read set 1:
// kReproject….
struct HoleParams {
    HoleFrameBuffer frames;      // this one, the one before
    VisibilityBuffer visibility;
    ViewBuffer views;
    UintBuffer counters;
    UintBuffer lists;            // holes still to be filled: three parts of list_size
    Uvec4Buffer light_in;        // filter_holes.comp, shade_holes.comp
    Uvec4Buffer light_out;       // filter_holes.comp
    Uvec2Buffer radiance;
    uint width;
    uint height;
    uint hole_count;
    uint list;                   // kCounter… of the list to process
    uint stages;                 // kHoles…
    uint noise_frame;
    uint samples_per_pixel;
    uint path;                   // kPath…
    float max_indirect;
    float alpha;                 // least weight of the new frame
    uint corner_views;           // four indices of corner views, 8 bits each, or kNoCornerView
    ReprojectSettings settings;
};

// keep_holes.comp: light of holes into the pages of their views.
struct KeepHolesParams {
    HoleFrame frame;
    Uvec4Buffer light_in;
    Vec4Buffer diffuse;  // out, as in ViewLight
    Vec4Buffer specular;
    uint width;
    uint height;
    uint hole_count;
};

SHARED_END
#endif
