// SPDX-License-Identifier: Apache-2.0
// Addressing of pixels in a batch of equal-sized views.
#ifndef FIELDCAST_LIB_VIEWS
#define FIELDCAST_LIB_VIEWS

// Pixels of one view, rounded up so that every view starts at a multiple of 4.
uint view_stride(uint width, uint height) {
    return (width * height + 3u) & ~3u;
}

struct ViewPixel {
    uint view;
    uint x;
    uint y;
};

ViewPixel locate_pixel(uint index, uint width, uint height) {
    uint stride = view_stride(width, height);
    uint view = index / stride;
    uint inside = index - view * stride;
    uint y = inside / width;
    return ViewPixel(view, inside - y * width, y);
}

#endif
