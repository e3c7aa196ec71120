// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/source_frame.h"

#include <span>

namespace fieldcast::render {

/// Indices, within one view, of the tiles in which at least `least` pixels of `mask` (row-major) are set.
std::vector<std::uint32_t> choose_tiles(const std::vector<bool>& mask, glm::uvec2 size_px, std::uint32_t least);

/// Copies tiles of views into a plane, one after the other. Tiles that extend beyond a view repeat its border.
class TilePlane {
public:
    TilePlane(PlaneSemantic semantic, PlaneFormat format);

    /// Appends the tiles with the indices `tiles` of `view`, which must have the plane's format.
    void append(const Plane& view, std::span<const std::uint32_t> tiles);

    const Plane& plane() const { return plane_; } ///< has at least one row of tiles

private:
    Plane plane_;
    std::size_t tile_count_ = 0;
};

} // namespace fieldcast::render
