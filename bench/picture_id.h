// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lightfield/view_grid.h"

namespace fieldcast::bench {

/// Identifies a picture of a run: a frame and one of its views.
struct PictureId {
    std::uint32_t frame = 0;
    LatticePosition position;

    bool operator==(const PictureId&) const = default;
};

/// Row and column of a view in the 6×6 grid; all results name views this way.
struct ViewIndex {
    std::int32_t row = 0;
    std::int32_t col = 0;
};

inline ViewIndex view_index(LatticePosition position) {
    const LatticePosition first = lattice_position(ViewGrid{}, 0, 0);
    return {(position.row_halves - first.row_halves) / 2, (position.col_halves - first.col_halves) / 2};
}

} // namespace fieldcast::bench
