// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/guard_band.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace fieldcast {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Camera camera_720p() {
    return make_camera(glm::mat4(1.0F), 0.785F, 1280, 720);
}

/// A 6×6 grid in which a wall at `depth_m` moves by `step_px` per view.
ViewGrid grid_with_step(const Camera& source, float step_px, float depth_m, float convergence_m = kInfinity) {
    ViewGrid grid;
    const float spacing_m = step_px / (source.focal_px * (1.0F / depth_m - 1.0F / convergence_m));
    grid.geometry = {{spacing_m, spacing_m}, convergence_m};
    return grid;
}

std::vector<float> wall(const Camera& source, const GuardBand& widest, float depth_m) {
    const Camera widened = with_guard_band(source, widest);
    return std::vector<float>(std::size_t{widened.width_px} * widened.height_px, depth_m);
}

TEST(WidestGuardBand, IsTwoStepsLeftAndTopAndThreeRightAndBottom) {
    const Camera source = camera_720p();
    const ViewGrid grid = grid_with_step(source, 7.75F, 2.0F);
    EXPECT_EQ(widest_guard_band(source, grid, 2.0F), (GuardBand{16, 24, 16, 24})); // 15.5 and 23.25, rounded up
}

TEST(WidestGuardBand, CountsFarPointsOfConvergingViews) {
    const Camera source = camera_720p();
    // 8 px per step at 2 m, 0 at 4 m and −8 px at infinity: both sides need three steps.
    const ViewGrid grid = grid_with_step(source, 7.99F, 2.0F, 4.0F);
    EXPECT_EQ(widest_guard_band(source, grid, 2.0F), (GuardBand{24, 24, 24, 24}));
    EXPECT_EQ(widest_guard_band(source, grid, 4.0F), (GuardBand{24, 16, 24, 16})) << "only points behind 4 m";
}

TEST(WidestGuardBand, IsAtMostHalfTheImage) {
    const Camera source = camera_720p();
    EXPECT_EQ(widest_guard_band(source, grid_with_step(source, 8.0F, 2.0F), 0.001F), (GuardBand{640, 640, 360, 360}));
    ViewGrid single;
    single.rows = single.cols = 1;
    EXPECT_EQ(widest_guard_band(source, single, 0.001F), GuardBand{});
}

TEST(ChooseGuardBand, CoversAWallNearlyToTheLastStep) {
    const Camera source = camera_720p();
    const ViewGrid grid = grid_with_step(source, 7.99F, 2.0F);
    const GuardBand widest = widest_guard_band(source, grid, 2.0F);
    ASSERT_EQ(widest, (GuardBand{16, 24, 16, 24}));
    const GuardBandChoice choice = choose_guard_band(source, widest, wall(source, widest, 2.0F), grid);
    EXPECT_GE(choice.removed_share, 0.95);
    EXPECT_LE(choice.extra_share, 0.12);
    // Inner strips serve more views. The outermost step of a side serves one column or row of views, so the 5 % that
    // may remain are of that kind: every side has its inner steps.
    EXPECT_GE(choice.band.left_px, 8U);
    EXPECT_GE(choice.band.right_px, 16U);
    EXPECT_GE(choice.band.top_px, 8U);
    EXPECT_GE(choice.band.bottom_px, 16U);
    EXPECT_LT(choice.extra_share, (1320.0 * 760.0) / (1280.0 * 720.0) - 1.0);
}

TEST(ChooseGuardBand, RemovesEverythingWhenAskedTo) {
    const Camera source = camera_720p();
    const ViewGrid grid = grid_with_step(source, 7.99F, 2.0F);
    const GuardBand widest = widest_guard_band(source, grid, 2.0F);
    const GuardBandChoice choice = choose_guard_band(source, widest, wall(source, widest, 2.0F), grid, 1.0, 1.0);
    EXPECT_EQ(choice.removed_share, 1.0);
    EXPECT_EQ(choice.band, widest);
    EXPECT_NEAR(choice.extra_share, (1320.0 * 760.0) / (1280.0 * 720.0) - 1.0, 1e-12);
}

TEST(ChooseGuardBand, StopsAtTheCap) {
    const Camera source = camera_720p();
    const ViewGrid grid = grid_with_step(source, 60.0F, 2.0F);
    const GuardBand widest = widest_guard_band(source, grid, 2.0F);
    const GuardBandChoice choice = choose_guard_band(source, widest, wall(source, widest, 2.0F), grid);
    EXPECT_LE(choice.extra_share, 0.12);
    EXPECT_GT(choice.extra_share, 0.11) << "the cap is used up";
    EXPECT_LT(choice.removed_share, 0.95);
    EXPECT_GT(choice.removed_share, 0.16); // 12 % of the image, from the 75 % around it that some view sees
}

TEST(ChooseGuardBand, NeedsNoneForSkyAndForASingleView) {
    const Camera source = camera_720p();
    const ViewGrid grid = grid_with_step(source, 8.0F, 2.0F);
    const GuardBand widest = widest_guard_band(source, grid, 2.0F);
    const GuardBandChoice sky = choose_guard_band(source, widest, wall(source, widest, kInfinity), grid);
    EXPECT_EQ(sky.band, GuardBand{});
    EXPECT_EQ(sky.removed_share, 1.0);
    EXPECT_EQ(sky.extra_share, 0.0);
    ViewGrid single = grid;
    single.rows = single.cols = 1;
    EXPECT_EQ(choose_guard_band(source, widest, wall(source, widest, 2.0F), single).band, GuardBand{});
}

TEST(ChooseGuardBand, FollowsTheNearSide) {
    const Camera source = camera_720p();
    const ViewGrid grid = grid_with_step(source, 8.0F, 2.0F);
    const GuardBand widest = widest_guard_band(source, grid, 2.0F);
    const Camera widened = with_guard_band(source, widest);
    std::vector<float> depth = wall(source, widest, kInfinity);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const bool is_left = i % widened.width_px < widened.width_px / 4;
        depth[i] = is_left ? 2.0F : kInfinity;
    }
    const GuardBandChoice choice = choose_guard_band(source, widest, depth, grid);
    EXPECT_GT(choice.band.left_px, 8U);
    EXPECT_EQ(choice.band.right_px, 0U);
    EXPECT_GE(choice.removed_share, 0.95);
}

TEST(ChooseGuardBand, StepsOverStripsThatNoViewNeeds) {
    const Camera source = camera_720p();
    ViewGrid grid = grid_with_step(source, 8.0F, 2.0F);
    grid.rows = 1;
    const GuardBand widest{.left_px = 20, .right_px = 30, .top_px = 0, .bottom_px = 0};
    const Camera widened = with_guard_band(source, widest);
    std::vector<float> depth = wall(source, widest, kInfinity);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const std::size_t x = i % widened.width_px;
        depth[i] = x >= 20 + 1280 + 5 ? 2.0F : kInfinity; // five columns of sky at the right border
    }
    const GuardBandChoice choice = choose_guard_band(source, widest, depth, grid);
    EXPECT_GT(choice.band.right_px, 16U);
    EXPECT_EQ(choice.band.left_px, 0U);
    EXPECT_GE(choice.removed_share, 0.95);
}

/// Counts by brute force what the band is worth: views look at the same wall without occlusion, so each target pixel
/// outside the source image is one needed source pixel.
TEST(ChooseGuardBand, RemovedShareAgreesWithCountingTargetPixels) {
    const Camera source = make_camera(glm::mat4(1.0F), 0.785F, 160, 90);
    const ViewGrid grid = grid_with_step(source, 3.0F, 2.0F); // whole pixels: target pixels are source pixels
    const GuardBand widest = widest_guard_band(source, grid, 1.9F);
    const GuardBandChoice choice = choose_guard_band(source, widest, wall(source, widest, 2.0F), grid, 0.8, 0.5);
    const GuardBand& band = choice.band;
    int needed = 0;
    int removed = 0;
    for (const LatticePosition position : lattice_positions(grid)) {
        for (int y = 0; y < 90; ++y) {
            for (int x = 0; x < 160; ++x) {
                const int sx = x + 3 * position.col_halves / 2;
                const int sy = y + 3 * position.row_halves / 2;
                const bool is_outside = sx < 0 || sx >= 160 || sy < 0 || sy >= 90;
                const bool is_covered =
                    sx >= -static_cast<int>(band.left_px) && sx < 160 + static_cast<int>(band.right_px) &&
                    sy >= -static_cast<int>(band.top_px) && sy < 90 + static_cast<int>(band.bottom_px);
                needed += is_outside ? 1 : 0;
                removed += is_outside && is_covered ? 1 : 0;
            }
        }
    }
    EXPECT_NEAR(choice.removed_share, static_cast<double>(removed) / needed, 1e-3); // float rounding at the border
    EXPECT_GE(choice.removed_share, 0.8);
}

TEST(ChooseGuardBand, IgnoresDepthsThatAreNone) {
    const Camera source = camera_720p();
    const ViewGrid grid = grid_with_step(source, 8.0F, 2.0F);
    const GuardBand widest = widest_guard_band(source, grid, 2.0F);
    for (const float bad : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_EQ(choose_guard_band(source, widest, wall(source, widest, bad), grid).band, GuardBand{});
    }
    EXPECT_THROW(choose_guard_band(source, widest, std::vector<float>(7), grid), std::logic_error);
}

TEST(ChooseGuardBand, IsDeterministicOnNoisyDepth) {
    const Camera source = camera_720p();
    const ViewGrid grid = grid_with_step(source, 8.0F, 2.0F);
    const GuardBand widest = widest_guard_band(source, grid, 1.0F);
    std::vector<float> depth = wall(source, widest, 2.0F);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> noise(1.0F, 20.0F);
    std::ranges::generate(depth, [&] { return noise(random); });
    const auto start = std::chrono::steady_clock::now();
    const GuardBandChoice first = choose_guard_band(source, widest, depth, grid);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    RecordProperty("choose_guard_band_us", static_cast<int>(took.count() * 1000.0));
    const GuardBandChoice second = choose_guard_band(source, widest, depth, grid);
    EXPECT_EQ(first.band, second.band);
    EXPECT_EQ(first.removed_share, second.removed_share);
    EXPECT_GE(first.removed_share, 0.95);
}

} // namespace
} // namespace fieldcast
