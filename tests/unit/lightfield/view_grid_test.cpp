// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/view_grid.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <random>
#include <set>

namespace fieldcast {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

ViewGrid grid_of(std::uint32_t rows, std::uint32_t cols, Anchor anchor = Anchor::kLattice) {
    return {.rows = rows, .cols = cols, .geometry = {}, .anchor = anchor};
}

std::set<LatticePosition> position_set(const ViewGrid& grid) {
    const auto positions = lattice_positions(grid);
    return {positions.begin(), positions.end()};
}

TEST(ViewGrid, SourceIsViewTwoTwoOfSixBySix) {
    EXPECT_EQ(lattice_position(grid_of(6, 6), 2, 2), LatticePosition::whole(0, 0));
    EXPECT_EQ(lattice_position(grid_of(6, 6), 0, 0), LatticePosition::whole(-2, -2));
    EXPECT_EQ(lattice_position(grid_of(6, 6), 5, 5), LatticePosition::whole(3, 3));
    EXPECT_EQ(lattice_position(grid_of(3, 3), 1, 1), LatticePosition::whole(0, 0));
    EXPECT_EQ(lattice_position(grid_of(1, 45), 0, 22), LatticePosition::whole(0, 0));
    EXPECT_EQ(lattice_position(grid_of(1, 1), 0, 0), LatticePosition::whole(0, 0));
}

TEST(ViewGrid, LatticeGridsNest) {
    std::set<LatticePosition> all;
    for (std::uint32_t n = 1; n < 6; ++n) {
        const auto inner = position_set(grid_of(n, n));
        const auto outer = position_set(grid_of(n + 1, n + 1));
        EXPECT_EQ(inner.size(), std::size_t{n} * n);
        EXPECT_TRUE(std::ranges::includes(outer, inner)) << n;
        all.insert(outer.begin(), outer.end());
    }
    EXPECT_EQ(all.size(), 36U);
    EXPECT_EQ(all.count(LatticePosition::whole(0, 0)), 1U);
}

TEST(ViewGrid, PositionsAreRowMajorFromTheTopLeft) {
    EXPECT_THAT(lattice_positions(grid_of(2, 3)),
                ElementsAre(LatticePosition::whole(0, -1), LatticePosition::whole(0, 0), LatticePosition::whole(0, 1),
                            LatticePosition::whole(1, -1), LatticePosition::whole(1, 0), LatticePosition::whole(1, 1)));
}

TEST(ViewGrid, CentredGridsAreSymmetric) {
    for (std::uint32_t n = 1; n <= 7; ++n) {
        const ViewGrid grid = grid_of(n, n + 1, Anchor::kCentre);
        for (std::uint32_t row = 0; row < grid.rows; ++row) {
            for (std::uint32_t col = 0; col < grid.cols; ++col) {
                const LatticePosition a = lattice_position(grid, row, col);
                const LatticePosition b = lattice_position(grid, grid.rows - 1 - row, grid.cols - 1 - col);
                EXPECT_EQ(a, (LatticePosition{-b.row_halves, -b.col_halves}));
            }
        }
    }
    EXPECT_THAT(lattice_positions(grid_of(1, 2, Anchor::kCentre)),
                ElementsAre(LatticePosition{0, -1}, LatticePosition{0, 1}));
    EXPECT_EQ(lattice_position(grid_of(1, 2, Anchor::kCentre), 0, 1).col(), 0.5F);
    EXPECT_EQ(position_set(grid_of(5, 5, Anchor::kCentre)), position_set(grid_of(5, 5)));
}

TEST(GridProblem, NamesTheLimit) {
    EXPECT_EQ(grid_problem(grid_of(6, 6)), std::nullopt);
    EXPECT_EQ(grid_problem(grid_of(1, 72)), std::nullopt);
    EXPECT_EQ(grid_problem(grid_of(9, 9)), "grid 9x9: 81 views, at most 72");
    EXPECT_THAT(grid_problem(grid_of(0, 4)), testing::Optional(HasSubstr("start at 1")));
    // 65536 · 65536 is 0 in 32 bits.
    EXPECT_THAT(grid_problem(grid_of(65536, 65536)), testing::Optional(HasSubstr("4294967296 views")));
}

TEST(GridProblem, RefusesMeaninglessGeometry) {
    ViewGrid grid;
    grid.geometry.spacing_m = {0.0F, 0.0F};
    EXPECT_EQ(grid_problem(grid), std::nullopt);
    for (const float bad : {-0.01F, kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
        grid.geometry.spacing_m = {0.03F, bad};
        EXPECT_NE(grid_problem(grid), std::nullopt) << bad;
    }
    grid.geometry.spacing_m = {0.03F, 0.03F};
    for (const float bad : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
        grid.geometry.convergence_m = bad;
        EXPECT_NE(grid_problem(grid), std::nullopt) << bad;
    }
}

TEST(ParseGrid, ReadsRowsTimesColumns) {
    ASSERT_TRUE(parse_grid("1x45"));
    EXPECT_EQ(parse_grid("1x45")->rows, 1U);
    EXPECT_EQ(parse_grid("1x45")->cols, 45U);
    EXPECT_EQ(parse_grid("4X5")->cols, 5U);
    EXPECT_TRUE(parse_grid("0x0")) << "limits are checked by grid_problem";
}

TEST(ParseGrid, RefusesEverythingElse) {
    for (const char* text : {"", "4", "4x", "x4", "4x4 ", " 4x4", "-4x4", "+4x4", "4x4x4", "4*4", "99999999999x1",
                             "4x-1", "0x10x1", "4.0x4"}) {
        EXPECT_FALSE(parse_grid(text)) << text;
    }
}

/// Random pose, grid geometry and point, fixed seed.
struct RandomRig {
    explicit RandomRig(unsigned seed) : random(seed) {}
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }
    glm::mat4 pose() {
        glm::mat4 result = glm::translate(glm::mat4(1.0F), {between(-5, 5), between(-5, 5), between(-5, 5)});
        const glm::vec3 axis = glm::normalize(glm::vec3(between(-1, 1), between(-1, 1), between(0.1F, 1)));
        return glm::rotate(result, between(-3, 3), axis);
    }
    std::mt19937 random;
};

/// x_source = x_target + Δcol·d and y_source = y_target + Δrow·d (docs/lightfield.md), for the formula and the
/// projections. Float world coordinates of 10 m give 1e-6 m, at f = 900 px and 0.5 m depth 2e-3 px.
void expect_projection_identity(RandomRig& rig, float convergence_m) {
    const Camera source = make_camera(rig.pose(), rig.between(0.3F, 1.5F), 1280, 720);
    const LatticeGeometry geometry{{rig.between(0.0F, 0.1F), rig.between(0.0F, 0.1F)}, convergence_m};
    const LatticePosition position{static_cast<int>(rig.between(-8, 8)), static_cast<int>(rig.between(-8, 8))};
    const Camera target = view_camera(source, geometry, position, vertical_fov(source), 1280, 720);
    const float depth_m = rig.between(0.5F, 50.0F);
    const glm::vec2 at_source(rig.between(0, 1280), rig.between(0, 720));
    const glm::vec3 at_target = project(target, unproject(source, at_source, depth_m));
    const float dx = disparity_px(source.focal_px, geometry.spacing_m.x, depth_m, convergence_m);
    const float dy = disparity_px(source.focal_px, geometry.spacing_m.y, depth_m, convergence_m);
    EXPECT_NEAR(at_source.x, at_target.x + position.col() * dx, 0.02F);
    EXPECT_NEAR(at_source.y, at_target.y + position.row() * dy, 0.02F);
    EXPECT_NEAR(at_target.z, depth_m, 1e-4F) << "views look along the same axis from the same plane";
}

TEST(ViewCamera, ShiftsPointsByDisparity) {
    RandomRig rig(1);
    for (int i = 0; i < 2000; ++i) {
        expect_projection_identity(rig, kInfinity);
        expect_projection_identity(rig, rig.between(0.5F, 10.0F));
    }
}

TEST(ViewCamera, PointsAtTheConvergenceDepthDoNotMove) {
    const Camera source = make_camera(glm::mat4(1.0F), 0.8F, 640, 360);
    const LatticeGeometry geometry{{0.05F, 0.04F}, 2.0F};
    const glm::vec3 point = unproject(source, {100.0F, 200.0F}, 2.0F);
    for (const LatticePosition position : lattice_positions(grid_of(6, 6))) {
        const glm::vec3 seen = project(view_camera(source, geometry, position, 0.8F, 640, 360), point);
        EXPECT_NEAR(seen.x, 100.0F, 1e-3F);
        EXPECT_NEAR(seen.y, 200.0F, 1e-3F);
    }
}

TEST(ViewCamera, RightAndLowerViewsStandRightAndBelow) {
    const Camera source = make_camera(glm::mat4(1.0F), 0.8F, 640, 360);
    const Camera view = view_camera(source, {{0.05F, 0.04F}, kInfinity}, LatticePosition::whole(1, 2), 0.8F, 640, 360);
    EXPECT_EQ(glm::vec3(view.world_from_camera[3]), glm::vec3(0.1F, -0.04F, 0.0F));
    EXPECT_EQ(view.principal_px, source.principal_px);
}

TEST(ViewCamera, SourcePositionOfSourceSizeIsTheSource) {
    RandomRig rig(3);
    const Camera source = make_camera(rig.pose(), 0.9F, 321, 123);
    EXPECT_EQ(view_camera(source, {{0.05F, 0.04F}, 3.0F}, {}, 0.9F, 321, 123), source);
}

TEST(ViewCamera, SmallerViewsSeeTheSameAtTheirScale) {
    const Camera source = make_camera(glm::mat4(1.0F), 0.8F, 1280, 720);
    const LatticeGeometry geometry{{0.05F, 0.04F}, 2.0F};
    const LatticePosition position = LatticePosition::whole(-1, 2);
    const Camera full = view_camera(source, geometry, position, 0.8F, 1280, 720);
    const Camera half = view_camera(source, geometry, position, 0.8F, 640, 360);
    const glm::vec3 point(0.3F, -0.2F, -4.0F);
    EXPECT_NEAR(project(half, point).x, 0.5F * project(full, point).x, 1e-3F);
    EXPECT_NEAR(project(half, point).y, 0.5F * project(full, point).y, 1e-3F);
}

} // namespace
} // namespace fieldcast
