// SPDX-License-Identifier: Apache-2.0
#include "core/image/quilt.h"

#include "core/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fieldcast::image {

namespace {

constexpr std::byte kSeparatorGrey{0x40};
constexpr std::size_t kPixelBytes = 3;

void check_views(const ViewGrid& grid, std::span<const View> views) {
    FC_ASSERT(!views.empty() && views.size() == grid.view_count(), "one image per view of the grid");
    const Plane& first = views.front().image;
    for (const View& view : views) {
        const bool has_size = view.image.width_px == first.width_px && view.image.height_px == first.height_px;
        const bool has_pixels =
            view.image.bytes.size() == plane_bytes(PlaneFormat::kRgb8, first.width_px, first.height_px);
        FC_ASSERT(view.image.format == PlaneFormat::kRgb8 && has_size && has_pixels, "views are kRgb8 and of one size");
    }
}

Plane blank(std::uint32_t width_px, std::uint32_t height_px, std::byte grey) {
    Plane plane{PlaneSemantic::kColour, PlaneFormat::kRgb8, width_px, height_px, {}};
    plane.bytes.resize(plane_bytes(plane.format, width_px, height_px), grey);
    return plane;
}

/// Copies `tile` into `sheet` with its top left corner at (x, y).
void paste(Plane& sheet, const Plane& tile, std::uint32_t x, std::uint32_t y) {
    const std::size_t row_bytes = tile.width_px * kPixelBytes;
    for (std::uint32_t row = 0; row < tile.height_px; ++row) {
        const std::size_t to = (static_cast<std::size_t>(y + row) * sheet.width_px + x) * kPixelBytes;
        std::copy_n(tile.bytes.begin() + static_cast<std::ptrdiff_t>(row * row_bytes), row_bytes,
                    sheet.bytes.begin() + static_cast<std::ptrdiff_t>(to));
    }
}

} // namespace

QuiltLayout choose_quilt_layout(const ViewGrid& grid) {
    if (grid.rows > 1) {
        return {grid.cols, grid.rows};
    }
    const std::uint32_t count = grid.cols;
    for (auto rows = static_cast<std::uint32_t>(std::sqrt(count)); rows > 0; --rows) {
        const std::uint32_t cols = count / rows;
        if (cols * rows == count && cols <= 2 * rows) {
            return {cols, rows};
        }
    }
    const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(count)));
    return {side, (count + side - 1) / side};
}

Plane assemble_quilt(const ViewGrid& grid, std::span<const View> views, const QuiltLayout& layout) {
    check_views(grid, views);
    FC_ASSERT(layout.cols * layout.rows >= views.size(), "each view has a tile");
    const Plane& first = views.front().image;
    Plane quilt = blank(first.width_px * layout.cols, first.height_px * layout.rows, std::byte{0});
    for (std::uint32_t i = 0; i < grid.view_count(); ++i) {
        const std::uint32_t row = i / grid.cols;
        const std::uint32_t number =
            (grid.rows - 1 - row) * grid.cols + i % grid.cols; // of the quilt: bottom row first
        const std::uint32_t tile_row = layout.rows - 1 - number / layout.cols;
        paste(quilt, views[i].image, number % layout.cols * first.width_px, tile_row * first.height_px);
    }
    return quilt;
}

std::string quilt_suffix(const QuiltLayout& layout, const Plane& view) {
    char text[64];
    const double aspect = static_cast<double>(view.width_px) / view.height_px;
    std::snprintf(text, sizeof text, "_qs%ux%ua%.4g", layout.cols, layout.rows, aspect);
    return text;
}

Plane contact_sheet(const ViewGrid& grid, std::span<const View> views, std::uint32_t separator_px) {
    check_views(grid, views);
    const Plane& first = views.front().image;
    const std::uint32_t step_x = first.width_px + separator_px;
    const std::uint32_t step_y = first.height_px + separator_px;
    Plane sheet = blank(step_x * grid.cols - separator_px, step_y * grid.rows - separator_px, kSeparatorGrey);
    for (std::uint32_t i = 0; i < grid.view_count(); ++i) {
        paste(sheet, views[i].image, i % grid.cols * step_x, i / grid.cols * step_y);
    }
    return sheet;
}

} // namespace fieldcast::image
