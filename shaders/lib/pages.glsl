// SPDX-License-Identifier: Apache-2.0
// Pages of the source (shared/frame.h): what its pixels see, and the BLEND surfaces in front of that.
#ifndef FIELDCAST_LIB_PAGES
#define FIELDCAST_LIB_PAGES
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

Visibility page_visibility(VisibilityBuffer visibility, VisibilityBuffer layers, uint page, uint pixel) {
    if (page == 0u) {
        return visibility.at[pixel];
    }
    return layers.at[pixel * kMaxLayers + page - 1u];
}

#endif
