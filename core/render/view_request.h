// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"

#include <vector>

namespace fieldcast::render {

/// Which views to make. All share geometry, field of view and size, so that they are one batch.
struct ViewRequest {
    LatticeGeometry geometry;
    float fovy_rad = 0.785398F; ///< ≤ the source's
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0; ///< ≤ the source's
    std::vector<LatticePosition> positions;

    bool operator==(const ViewRequest&) const = default;
};

} // namespace fieldcast::render
