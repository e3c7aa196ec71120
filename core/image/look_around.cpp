// SPDX-License-Identifier: Apache-2.0
#include "core/image/look_around.h"

#include "core/base/error.h"
#include "core/image/animated_png.h"

namespace fieldcast::image {

namespace {

std::vector<std::uint32_t> serpentine(const ViewGrid& grid) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t row = 0; row < grid.rows; ++row) {
        for (std::uint32_t i = 0; i < grid.cols; ++i) {
            const std::uint32_t col = row % 2 == 0 ? i : grid.cols - 1 - i;
            order.push_back(row * grid.cols + col);
        }
    }
    return order;
}

/// `order`, followed by the same way back without its two ends.
std::vector<std::uint32_t> there_and_back(std::vector<std::uint32_t> order) {
    for (std::size_t i = order.size() - 1; i-- > 1;) {
        order.push_back(order[i]);
    }
    return order;
}

std::vector<std::uint32_t> border(const ViewGrid& grid) {
    const std::uint32_t last_row = grid.rows - 1;
    const std::uint32_t last_col = grid.cols - 1;
    std::vector<std::uint32_t> order;
    const auto add = [&](std::uint32_t row, std::uint32_t col) { order.push_back(row * grid.cols + col); };
    for (std::uint32_t col = 0; col < last_col; ++col) {
        add(0, col);
    }
    for (std::uint32_t row = 0; row < last_row; ++row) {
        add(row, last_col);
    }
    for (std::uint32_t col = last_col; col > 0; --col) {
        add(last_row, col);
    }
    for (std::uint32_t row = last_row; row > 0; --row) {
        add(row, 0);
    }
    return order;
}

} // namespace

std::vector<std::uint32_t> sweep_order(const ViewGrid& grid, SweepPath path) {
    FC_ASSERT(grid.view_count() > 0, "a grid has views");
    const bool is_line = grid.rows == 1 || grid.cols == 1;
    return path == SweepPath::kCircle && !is_line ? border(grid) : there_and_back(serpentine(grid));
}

void write_look_around(const std::filesystem::path& file, const ViewGrid& grid, std::span<const View> views,
                       SweepPath path, std::chrono::milliseconds delay) {
    FC_ASSERT(views.size() == grid.view_count(), "one image per view of the grid");
    std::vector<const Plane*> frames;
    for (const std::uint32_t view : sweep_order(grid, path)) {
        frames.push_back(&views[view].image);
    }
    write_animated_png(file, frames, delay);
}

} // namespace fieldcast::image
