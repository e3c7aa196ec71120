// SPDX-License-Identifier: Apache-2.0
#include "core/render/views/corner_views.h"

#include <algorithm>

namespace fieldcast::render {

namespace {

/// Index of `position` in `positions`; a missing one is appended.
std::uint32_t index_of(std::vector<LatticePosition>& positions, LatticePosition position) {
    const auto found = std::ranges::find(positions, position);
    const auto index = static_cast<std::uint32_t>(found - positions.begin());
    if (found == positions.end()) {
        positions.push_back(position);
    }
    return index;
}

} // namespace

std::vector<std::uint32_t> choose_corners(const HoleFilling& holes, std::vector<LatticePosition>& positions) {
    if (holes.cascade_rows == 0 || holes.cascade_cols == 0) {
        return {};
    }
    ViewGrid grid;
    grid.rows = holes.cascade_rows;
    grid.cols = holes.cascade_cols;
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t row : {0U, grid.rows - 1}) {
        for (const std::uint32_t col : {0U, grid.cols - 1}) {
            const std::uint32_t index = index_of(positions, lattice_position(grid, row, col));
            if (std::ranges::find(corners, index) == corners.end()) {
                corners.push_back(index);
            }
        }
    }
    return corners;
}

} // namespace fieldcast::render
