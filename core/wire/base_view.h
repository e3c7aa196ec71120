// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/codec/strip.h"
#include "core/lightfield/view_grid.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fieldcast::wire {

/// The view from which the one at `position` may be predicted, in the same frame: the one nearest to the source of
/// those that are whole steps away, on half steps above and left of it. Every grid that shows `position` shows it, too,
/// so that clients with different grids share predicted views.
LatticePosition base_position(LatticePosition position);

/// The part of a frame of views that its other parts may be predicted from.
std::uint32_t base_part(const ViewGrid& grid);

/// What a receiver has of the base view of a frame, still encoded: memory of one encoded view.
class BaseStrips {
public:
    void keep(codec::RowBand band, std::span<const std::byte> strip);
    std::span<const std::byte> find(codec::RowBand band) const; ///< empty: not there (yet)

private:
    struct Kept {
        codec::RowBand band;
        std::vector<std::byte> bytes;
    };
    std::vector<Kept> strips_;
};

} // namespace fieldcast::wire
