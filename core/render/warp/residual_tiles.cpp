// SPDX-License-Identifier: Apache-2.0
#include "core/render/warp/residual_tiles.h"

#include "core/base/error.h"

#include <algorithm>

namespace fieldcast::render {

std::vector<std::uint32_t> choose_tiles(const std::vector<bool>& mask, glm::uvec2 size_px, std::uint32_t least) {
    const glm::uvec2 tiles = residual_tiles(size_px.x, size_px.y);
    std::vector<std::uint32_t> holes(std::size_t{tiles.x} * tiles.y);
    for (std::uint32_t y = 0; y < size_px.y; ++y) {
        for (std::uint32_t x = 0; x < size_px.x; ++x) {
            const bool is_hole = mask[std::size_t{y} * size_px.x + x];
            holes[std::size_t{y / kResidualTile} * tiles.x + x / kResidualTile] += is_hole ? 1 : 0;
        }
    }
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t tile = 0; tile < holes.size(); ++tile) {
        if (holes[tile] >= least) {
            chosen.push_back(tile);
        }
    }
    return chosen;
}

TilePlane::TilePlane(PlaneSemantic semantic, PlaneFormat format)
    : plane_{semantic, format, kResidualColumns * kResidualTile, residual_height(0), {}} {
    plane_.bytes.resize(plane_bytes(format, plane_.width_px, plane_.height_px));
}

void TilePlane::append(const Plane& view, std::span<const std::uint32_t> tiles) {
    FC_ASSERT(view.format == plane_.format, "the view does not have the plane's format");
    const std::uint32_t pixel_bytes = bytes_per_pixel(view.format);
    const std::uint32_t columns = residual_tiles(view.width_px, view.height_px).x;
    plane_.height_px = residual_height(tile_count_ + tiles.size());
    plane_.bytes.resize(plane_bytes(plane_.format, plane_.width_px, plane_.height_px));
    for (const std::uint32_t tile : tiles) {
        const auto slot = static_cast<std::uint32_t>(tile_count_++);
        for (std::uint32_t i = 0; i < kResidualTile * kResidualTile; ++i) {
            const glm::uvec2 inside(i % kResidualTile, i / kResidualTile);
            const glm::uvec2 from = glm::min(glm::uvec2(tile % columns, tile / columns) * kResidualTile + inside,
                                             glm::uvec2(view.width_px, view.height_px) - 1U);
            const glm::uvec2 to = glm::uvec2(slot % kResidualColumns, slot / kResidualColumns) * kResidualTile + inside;
            const std::size_t source = pixel_bytes * (std::size_t{from.y} * view.width_px + from.x);
            const std::size_t target = pixel_bytes * (std::size_t{to.y} * plane_.width_px + to.x);
            std::copy_n(&view.bytes[source], pixel_bytes, &plane_.bytes[target]);
        }
    }
}

} // namespace fieldcast::render
