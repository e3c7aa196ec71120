// SPDX-License-Identifier: Apache-2.0
// Pages of the sources (shared/frame.h): the visible surfaces of their pixels, and the BLEND surfaces in front of them.
#ifndef FIELDCAST_LIB_PAGES
#define FIELDCAST_LIB_PAGES
#include "lib/views.glsl"
#include "shared/frame.h"

struct PagePixel {
    uint page;
    uint pixel; // in its page
    uint x;
    uint y;
};

PagePixel locate_page_pixel(uint index, uint width, uint height) {
    uint page = index / (width * height);
    uint pixel = index - page * width * height;
    uint y = pixel / width;
    return PagePixel(page, pixel, pixel - y * width, y);
}

// Tiles of kTileSide² pixels: row by row, one page after the other.
uint tile_of(PagePixel at, uint width, uint height) {
    uvec2 tiles = (uvec2(width, height) + kTileSide - 1u) / kTileSide;
    return (at.page * tiles.y + at.y / kTileSide) * tiles.x + at.x / kTileSide;
}

// The pixel `inside` of a tile, which may lie beyond the page's right or lower edge.
PagePixel tile_pixel(uint tile, uvec2 inside, uint width, uint height) {
    uvec2 tiles = (uvec2(width, height) + kTileSide - 1u) / kTileSide;
    uint row = tile / tiles.x;
    uint page = row / tiles.y;
    uint x = (tile - row * tiles.x) * kTileSide + inside.x;
    uint y = (row - page * tiles.y) * kTileSide + inside.y;
    return PagePixel(page, y * width + x, x, y);
}

uint source_of_page(uint page, uint source_count) {
    return page % source_count;
}

// `stride`: pixels from one source to the next (lib/views.glsl).
Visibility page_visibility(VisibilityBuffer visibility, VisibilityBuffer layers, uint page, uint source_count, uint stride,
                           uint pixel) {
    uint layer = page / source_count;
    uint at = source_of_page(page, source_count) * stride + pixel;
    if (layer == 0u) {
        return visibility.at[at];
    }
    return layers.at[at * kMaxLayers + layer - 1u];
}

#endif
