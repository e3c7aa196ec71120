// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"

#include <array>

namespace fieldcast {

/// Pixels of a target view that could not be taken from the source, by reason. All counts are pixels of one view.
struct DiscardCounts {
    std::uint32_t out_of_frustum = 0; ///< projects outside the source image and its guard band
    std::uint32_t id = 0;             ///< other instance or material seen there
    std::uint32_t plane = 0;          ///< other surface: plane or tangential distance
    std::uint32_t normal = 0;         ///< shading normals differ too much

    std::uint32_t total() const { return out_of_frustum + id + plane + normal; }
    bool operator==(const DiscardCounts&) const = default;
};

/// One finished view: an RGB8 sRGB image at a lattice position.
struct View {
    LatticePosition position;
    Plane image; ///< kColour, kRgb8
    DiscardCounts discards;
};

/// Finished images of one light field, in the row-major order of the grid they were asked for.
struct Views {
    FrameHeader header;
    std::vector<View> views;
};

} // namespace fieldcast
