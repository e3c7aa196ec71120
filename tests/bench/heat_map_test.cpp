// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/heat_map.h"

#include <gtest/gtest.h>

namespace fieldcast::bench {
namespace {

/// Sum of the channels in the middle of a square's upper left quarter, where no dot is.
int brightness(const Plane& plane, std::uint32_t row, std::uint32_t col) {
    const std::size_t x = col * 50 + 8;
    const std::size_t y = row * 50 + 8;
    int sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        sum += std::to_integer<int>(plane.bytes[3 * (y * plane.width_px + x) + c]);
    }
    return sum;
}

std::byte centre(const Plane& plane, std::uint32_t row, std::uint32_t col) {
    return plane.bytes[3 * (static_cast<std::size_t>(row * 50 + 24) * plane.width_px + col * 50 + 24)];
}

TEST(HeatMap, GrowsBrighterRowByRowAndMarksSources) {
    ViewGrid grid;
    grid.rows = 2;
    grid.cols = 3;
    const std::vector<double> values{0.0, 1.0, 2.0, 3.0, 4.0, 9.0};
    const Plane plane = heat_map(grid, values, 4.0, {lattice_position(grid, 1, 0)});
    EXPECT_EQ(plane.width_px, 3U * 48U + 2U * 2U);
    EXPECT_EQ(plane.height_px, 2U * 48U + 2U);
    for (std::size_t i = 1; i < 5; ++i) {
        const auto at = static_cast<std::uint32_t>(i);
        EXPECT_GT(brightness(plane, at / 3, at % 3), brightness(plane, (at - 1) / 3, (at - 1) % 3)) << i;
    }
    EXPECT_EQ(brightness(plane, 1, 2), brightness(plane, 1, 1)); // more than the brightest
    EXPECT_EQ(centre(plane, 1, 0), std::byte{255});
    EXPECT_NE(centre(plane, 0, 0), std::byte{255});
}

TEST(HeatMap, AllZeroIsDark) {
    const std::vector<double> values(36, 0.0);
    const Plane plane = heat_map({}, values, 0.0, {});
    EXPECT_EQ(brightness(plane, 0, 0), brightness(plane, 5, 5));
    EXPECT_LT(brightness(plane, 0, 0), 3 * 64);
}

} // namespace
} // namespace fieldcast::bench
