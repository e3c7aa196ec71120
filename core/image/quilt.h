// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/views.h"

#include <cstdint>
#include <span>
#include <string>

namespace fieldcast::image {

/// Tiles of a quilt, the image that lenticular displays take: view 0, the leftmost one, is the tile at the bottom left;
/// the next views follow to the right, then in the row above.
///
///   1×6 views as 3×2 tiles:   3 4 5        2×3 views as 3×2 tiles:   (0,0) (0,1) (0,2)
///                             0 1 2                                  (1,0) (1,1) (1,2)
struct QuiltLayout {
    std::uint32_t cols = 1;
    std::uint32_t rows = 1;

    bool operator==(const QuiltLayout&) const = default;
};

/// Grids keep their shape. A single row of views is wrapped so that the tiles form about a square, without empty tiles
/// if possible with at most twice as many columns as rows: 45 views as 9×5, 46 as 7×7 with three black tiles.
QuiltLayout choose_quilt_layout(const ViewGrid& grid);

/// `views` are those of `grid`, row-major, all kRgb8 of one size. Unused tiles are black.
Plane assemble_quilt(const ViewGrid& grid, std::span<const View> views, const QuiltLayout& layout);

/// End of a file name, before its extension, from which display software reads the layout: "_qs9x5a0.75" (columns,
/// rows, width / height of one view).
std::string quilt_suffix(const QuiltLayout& layout, const Plane& view);

/// All views in one image for people: view(0,0) on top left, as in the grid, with `separator_px` of grey between
/// neighbours.
Plane contact_sheet(const ViewGrid& grid, std::span<const View> views, std::uint32_t separator_px = 2);

} // namespace fieldcast::image
