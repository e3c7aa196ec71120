// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/residual_layer.h"

#include "core/lightfield/plane.h"

#include <algorithm>

namespace fieldcast {

glm::uvec2 residual_tiles(std::uint32_t width_px, std::uint32_t height_px) {
    return {(width_px + kResidualTile - 1) / kResidualTile, (height_px + kResidualTile - 1) / kResidualTile};
}

std::uint32_t residual_height(std::size_t tile_count) {
    const auto rows = static_cast<std::uint32_t>((tile_count + kResidualColumns - 1) / kResidualColumns);
    return std::max(1U, rows) * kResidualTile;
}

std::size_t max_residual_tiles() {
    return std::size_t{kResidualColumns} * (kMaxPlaneSide / kResidualTile);
}

} // namespace fieldcast
