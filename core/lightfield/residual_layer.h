// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"

#include <cstdint>
#include <vector>

namespace fieldcast {

inline constexpr std::uint32_t kResidualTile = 8;      ///< side of a tile, pixels
inline constexpr std::uint32_t kResidualColumns = 128; ///< tiles side by side in a plane
inline constexpr std::size_t kMaxResidualViews = 4;

/// What some views see and the source does not, for clients that make views without the scene: square tiles of these
/// views, row by row in planes of kResidualColumns tiles. The views have the source's size and field of view.
struct ResidualLayer {
    std::vector<LatticePosition> positions; ///< of the views; empty: there is no such layer
    LatticeGeometry geometry;
    /// Numbers, growing: (view · tile rows + tile row) · tile columns + tile column. Tiles at the right and lower
    /// border may reach beyond the view; what they hold there means nothing.
    std::vector<std::uint32_t> tiles;

    bool operator==(const ResidualLayer&) const = default;
};

/// Tiles of one view of that size: columns, rows.
glm::uvec2 residual_tiles(std::uint32_t width_px, std::uint32_t height_px);

/// Height of planes with `tile_count` tiles; one row of tiles at least, so that there is a plane.
std::uint32_t residual_height(std::size_t tile_count);

/// As many tiles fit into the tallest plane.
std::size_t max_residual_tiles();

} // namespace fieldcast
