// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"

#include <cstdint>

namespace fieldcast::wire {

/// The views of a frame of views.
struct ViewSet {
    ViewGrid grid;
    std::uint32_t width_px = 0;  ///< of each view
    std::uint32_t height_px = 0; ///< of each view
    float fovy_rad = 1.0F;       ///< vertical, over height_px

    bool operator==(const ViewSet&) const = default;
};

} // namespace fieldcast::wire
