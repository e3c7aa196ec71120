// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/camera.h"
#include "core/lightfield/view_grid.h"

#include <vector>

namespace fieldcast::render {

/// Which views to make. All share geometry, field of view and size, so that they are one batch.
struct ViewRequest {
    LatticeGeometry geometry;
    float fovy_rad = 0.785398F; ///< ≤ the source's
    std::uint32_t width_px = 0;  ///< ≤ the source's, and guard_band
    std::uint32_t height_px = 0; ///< likewise
    std::vector<LatticePosition> positions;
    GuardBand guard_band{}; ///< pixels of width and height that lie beyond the field of view

    bool operator==(const ViewRequest&) const = default;
};

/// Pixels from one view of a batch to the next, in all planes: view_stride() of shaders/lib/views.glsl.
constexpr std::uint32_t view_stride(std::uint32_t width_px, std::uint32_t height_px) {
    return (width_px * height_px + 3U) & ~3U;
}

constexpr std::uint32_t view_stride(const ViewRequest& request) {
    return view_stride(request.width_px, request.height_px);
}

} // namespace fieldcast::render
