// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"
#include "core/lightfield/view_grid.h"

#include <vector>

namespace fieldcast::render {

/// The views to render. All share geometry, field of view and size, so they form one batch.
struct ViewRequest {
    LatticeGeometry geometry;
    float fovy_rad = 0.785398F; ///< ≤ the source's
    std::uint32_t width_px = 0;  ///< includes guard_band; ≤ the source's
    std::uint32_t height_px = 0; ///< includes guard_band; ≤ the source's
    std::vector<LatticePosition> positions;
    GuardBand guard_band{}; ///< pixels of width_px and height_px beyond the field of view

    bool operator==(const ViewRequest&) const = default;
};

/// Pixels from one view of a batch to the next, in all planes; equals view_stride() of shaders/lib/views.glsl.
constexpr std::uint32_t view_stride(std::uint32_t width_px, std::uint32_t height_px) {
    return (width_px * height_px + 3U) & ~3U;
}

constexpr std::uint32_t view_stride(const ViewRequest& request) {
    return view_stride(request.width_px, request.height_px);
}

} // namespace fieldcast::render
