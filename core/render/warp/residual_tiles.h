// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"

#include <span>

namespace fieldcast::render {

/// Numbers, within one view, of the tiles in which at least `least` pixels of `mask` (row-major) are set.
std::vector<std::uint32_t> choose_tiles(const std::vector<bool>& mask, glm::uvec2 size_px, std::uint32_t least);

/// Copies tiles out of views into a plane, one after the other. Tiles that reach beyond a view repeat its border.
class TilePlane {
public:
    TilePlane(PlaneSemantic semantic, PlaneFormat format);

    /// Appends those tiles (numbers within the view) of `view`, which has the plane's format.
    void append(const Plane& view, std::span<const std::uint32_t> tiles);

    const Plane& plane() const { return plane_; } ///< one row of tiles at least

private:
    Plane plane_;
    std::size_t tile_count_ = 0;
};

} // namespace fieldcast::render
