// SPDX-License-Identifier: Apache-2.0
#include "core/wire/base_view.h"

#include "core/base/error.h"

#include <algorithm>
#include <cstdlib>

namespace fieldcast::wire {

LatticePosition base_position(LatticePosition position) {
    return {-std::abs(position.row_halves % 2), -std::abs(position.col_halves % 2)};
}

std::uint32_t base_part(const ViewGrid& grid) {
    const auto positions = lattice_positions(grid);
    const auto found = std::ranges::find(positions, base_position(positions.front()));
    FC_ASSERT(found != positions.end(), "every grid contains its base view");
    return static_cast<std::uint32_t>(found - positions.begin());
}

void BaseStrips::keep(codec::RowBand band, std::span<const std::byte> strip) {
    strips_.push_back({band, {strip.begin(), strip.end()}});
}

std::span<const std::byte> BaseStrips::find(codec::RowBand band) const {
    const auto found = std::ranges::find(strips_, band, &Kept::band);
    return found == strips_.end() ? std::span<const std::byte>() : std::span<const std::byte>(found->bytes);
}

} // namespace fieldcast::wire
