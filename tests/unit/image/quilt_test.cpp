// SPDX-License-Identifier: Apache-2.0
#include "core/image/quilt.h"

#include "tests/unit/image/test_image.h"

namespace fieldcast::image {
namespace {

ViewGrid grid_of(std::uint32_t rows, std::uint32_t cols) {
    ViewGrid grid;
    grid.rows = rows;
    grid.cols = cols;
    return grid;
}

/// Views of 3×2 px; red of every pixel is 10 + index of the view, green 0 in its upper and 1 in its lower row.
std::vector<View> numbered_views(const ViewGrid& grid) {
    std::vector<View> views;
    for (std::uint32_t i = 0; i < grid.view_count(); ++i) {
        Plane image = test::flat_plane(3, 2, static_cast<std::uint8_t>(10 + i), 0, 200);
        for (std::size_t byte = 10; byte < 18; byte += 3) {
            image.bytes[byte] = std::byte{1};
        }
        views.push_back({lattice_position(grid, i / grid.cols, i % grid.cols), image, {}});
    }
    return views;
}

int channel_at(const Plane& plane, std::uint32_t x, std::uint32_t y, std::size_t channel) {
    return std::to_integer<int>(plane.bytes[(static_cast<std::size_t>(y) * plane.width_px + x) * 3 + channel]);
}

/// View shown by the tile, −1 for a black one.
int view_at(const Plane& quilt, std::uint32_t tile_col, std::uint32_t tile_row) {
    const int red = channel_at(quilt, tile_col * 3 + 2, tile_row * 2 + 1, 0);
    return red == 0 ? -1 : red - 10;
}

TEST(Quilt, SweepStartsAtTheBottomLeft) {
    const ViewGrid grid = grid_of(1, 6);
    const Plane quilt = assemble_quilt(grid, numbered_views(grid), {3, 2});
    ASSERT_EQ(quilt.width_px, 9U);
    ASSERT_EQ(quilt.height_px, 4U);
    const int expected[2][3]{{3, 4, 5}, {0, 1, 2}};
    for (std::uint32_t row = 0; row < 2; ++row) {
        for (std::uint32_t col = 0; col < 3; ++col) {
            EXPECT_EQ(view_at(quilt, col, row), expected[row][col]);
            EXPECT_EQ(channel_at(quilt, col * 3, row * 2, 1), 0) << "views are not flipped";
            EXPECT_EQ(channel_at(quilt, col * 3, row * 2 + 1, 1), 1);
        }
    }
}

TEST(Quilt, GridsKeepTheirShape) {
    const ViewGrid grid = grid_of(2, 3);
    ASSERT_EQ(choose_quilt_layout(grid), (QuiltLayout{3, 2}));
    const Plane quilt = assemble_quilt(grid, numbered_views(grid), {3, 2});
    for (std::uint32_t i = 0; i < 6; ++i) {
        EXPECT_EQ(view_at(quilt, i % 3, i / 3), static_cast<int>(i));
    }
}

TEST(Quilt, LeavesUnusedTilesBlackOnTop) {
    const ViewGrid grid = grid_of(1, 3);
    const Plane quilt = assemble_quilt(grid, numbered_views(grid), {2, 2});
    EXPECT_EQ(view_at(quilt, 0, 1), 0);
    EXPECT_EQ(view_at(quilt, 0, 0), 2);
    EXPECT_EQ(view_at(quilt, 1, 0), -1);
}

TEST(Quilt, LayoutsOfSweeps) {
    EXPECT_EQ(choose_quilt_layout(grid_of(1, 45)), (QuiltLayout{9, 5}));
    EXPECT_EQ(choose_quilt_layout(grid_of(1, 48)), (QuiltLayout{8, 6}));
    EXPECT_EQ(choose_quilt_layout(grid_of(1, 72)), (QuiltLayout{9, 8}));
    EXPECT_EQ(choose_quilt_layout(grid_of(1, 46)), (QuiltLayout{7, 7}));
    EXPECT_EQ(choose_quilt_layout(grid_of(1, 1)), (QuiltLayout{1, 1}));
    for (std::uint32_t count = 1; count <= kMaxViews; ++count) {
        const QuiltLayout layout = choose_quilt_layout(grid_of(1, count));
        EXPECT_GE(layout.cols * layout.rows, count);
        EXPECT_LT(layout.cols * (layout.rows - 1), count) << "no row is empty";
    }
}

TEST(Quilt, SuffixNamesTilesAndAspect) {
    EXPECT_EQ(quilt_suffix({9, 5}, test::flat_plane(3, 4, 0, 0, 0)), "_qs9x5a0.75");
    EXPECT_EQ(quilt_suffix({6, 6}, test::flat_plane(16, 9, 0, 0, 0)), "_qs6x6a1.778");
}

TEST(Quilt, RefusesViewsThatDoNotFit) {
    const ViewGrid grid = grid_of(1, 3);
    std::vector<View> views = numbered_views(grid);
    EXPECT_THROW(assemble_quilt(grid, views, {1, 2}), std::logic_error);
    views[1].image.width_px = 2;
    EXPECT_THROW(assemble_quilt(grid, views, {3, 1}), std::logic_error);
    views.pop_back();
    EXPECT_THROW(contact_sheet(grid, views), std::logic_error);
}

TEST(ContactSheet, ShowsTheGridAsItIs) {
    const ViewGrid grid = grid_of(2, 3);
    const Plane sheet = contact_sheet(grid, numbered_views(grid), 2);
    ASSERT_EQ(sheet.width_px, 13U);
    ASSERT_EQ(sheet.height_px, 6U);
    EXPECT_EQ(channel_at(sheet, 0, 0, 0), 10);
    EXPECT_EQ(channel_at(sheet, 5, 0, 0), 11);
    EXPECT_EQ(channel_at(sheet, 12, 5, 0), 15);
    EXPECT_EQ(channel_at(sheet, 3, 0, 0), channel_at(sheet, 4, 3, 2)) << "separators are grey";
    EXPECT_EQ(contact_sheet(grid_of(1, 1), numbered_views(grid_of(1, 1))).width_px, 3U);
}

} // namespace
} // namespace fieldcast::image
