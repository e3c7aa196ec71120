// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"

#include <cstdint>
#include <vector>

namespace fieldcast {

inline constexpr std::uint32_t kResidualTile = 8;      ///< side of a tile, pixels
inline constexpr std::uint32_t kResidualColumns = 128; ///< tiles side by side in a plane
inline constexpr std::size_t kMaxResidualViews = 4;

/// Tiles of some views that show what the source does not, for clients that make views without the scene. The tiles are
/// square and lie row by row in planes of kResidualColumns tiles. The views have the source's size and field of view.
struct ResidualLayer {
    std::vector<LatticePosition> positions; ///< of the views; empty: no residual layer
    LatticeGeometry geometry;
    /// Tile numbers in ascending order: (view · tile rows + tile row) · tile columns + tile column. Tiles at the right
    /// and lower border may reach beyond the view; their pixels there are undefined.
    std::vector<std::uint32_t> tiles;

    bool operator==(const ResidualLayer&) const = default;
};

/// Tiles of one view of that size: columns, rows.
glm::uvec2 residual_tiles(std::uint32_t width_px, std::uint32_t height_px);

/// Height of planes with `tile_count` tiles: at least one row of tiles, so that planes are never empty.
std::uint32_t residual_height(std::size_t tile_count);

/// Number of tiles that fit into the tallest plane.
std::size_t max_residual_tiles();

} // namespace fieldcast
