// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/codec/strip.h"
#include "core/lightfield/view_grid.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fieldcast::wire {

/// Position of the base view, from which the view at `position` may be predicted in the same frame. Of the positions
/// whole steps away from `position`, it is the one nearest to the source; on half steps, the one above and left of the
/// source. Every grid with `position` has the base view, too, so clients with different grids share predicted views.
LatticePosition base_position(LatticePosition position);

/// Part number of the base view in a frame with the views of `grid`. Other parts may be predicted from it.
std::uint32_t base_part(const ViewGrid& grid);

/// The received strips of a frame's base view, still encoded. They take the memory of one encoded view.
class BaseStrips {
public:
    void keep(codec::RowBand band, std::span<const std::byte> strip);
    std::span<const std::byte> find(codec::RowBand band) const; ///< empty: not received (yet)

private:
    struct Kept {
        codec::RowBand band;
        std::vector<std::byte> bytes;
    };
    std::vector<Kept> strips_;
};

} // namespace fieldcast::wire
