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

} // namespace fieldcast::render
