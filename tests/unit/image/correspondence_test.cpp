// SPDX-License-Identifier: Apache-2.0
#include "core/image/correspondence.h"

#include "core/lightfield/view_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace fieldcast::image {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNothing = 0xFFFFFFFFU;

/// A view of `width` × 8 pixels from (x_m, 0, 0), focal length 100 px, of one object at one depth.
ViewSurfaces wall(float x_m, float depth_m, std::uint32_t width = 16) {
    ViewSurfaces view;
    view.camera.world_from_camera = glm::translate(glm::mat4(1.0F), {x_m, 0.0F, 0.0F});
    view.camera.focal_px = 100.0F;
    view.camera.width_px = width;
    view.camera.height_px = 8;
    view.camera.principal_px = {static_cast<float>(width) / 2.0F, 4.0F};
    view.depth_m.assign(std::size_t{width} * 8, depth_m);
    view.object.assign(view.depth_m.size(), std::isinf(depth_m) ? kNothing : 7U);
    return view;
}

std::size_t visible_count(const Correspondence& map) {
    return static_cast<std::size_t>(
        std::ranges::count_if(map.place, [](const auto& place) { return place.has_value(); }));
}

// Disparity f·b/z = 100 · 0.05 / 2 = 2.5 px: a point seen 2.5 px further right from a camera 5 cm further left.
TEST(Correspondence, FollowsTheDisparityOfAWall) {
    const Correspondence map = find_correspondence(wall(0.05F, 2.0F), wall(0.0F, 2.0F));
    ASSERT_TRUE(map.place[16 * 3 + 5]);
    EXPECT_NEAR(map.place[16 * 3 + 5]->x, 5.5F + 2.5F, 1e-4F);
    EXPECT_NEAR(map.place[16 * 3 + 5]->y, 3.5F, 1e-4F);
    // Places beyond the last centre, at 15.5, are outside: those of x + 2.5 > 15, so of the last three columns.
    EXPECT_EQ(visible_count(map), 13U * 8U);
}

// A floor 1 m below the cameras, seen at 0.5 … 3.5 px below the horizon: 200 … 29 m away. From pixel to pixel the depth
// changes by up to 200 %; compared as depths instead of inverse depths, nothing would be found.
TEST(Correspondence, FindsSurfacesAtGrazingAngles) {
    const auto floor_seen = [](float x_m) {
        ViewSurfaces view = wall(x_m, kInfinity);
        for (std::size_t i = 16 * 4; i < view.depth_m.size(); ++i) {
            view.depth_m[i] = 100.0F / (static_cast<float>(i / 16) + 0.5F - 4.0F);
            view.object[i] = 7U;
        }
        view.camera.world_from_camera[3].z = x_m; // also goes back, so that places lie between rows
        return view;
    };
    const Correspondence map = find_correspondence(floor_seen(0.0F), floor_seen(0.0F));
    EXPECT_EQ(visible_count(map), 16U * 8U);
    ViewSurfaces behind = floor_seen(5.0F);
    behind.camera.world_from_camera[3].x = 0.0F;
    const Correspondence back = find_correspondence(floor_seen(0.0F), behind);
    // Row 6 is 40 m away, 45 m from behind: 2.22 px below the horizon, between rows 5 and 6 of the floor.
    ASSERT_TRUE(back.place[16 * 6 + 8]);
    EXPECT_NEAR(back.place[16 * 6 + 8]->y, 4.0F + 100.0F / 45.0F, 1e-3F);
}

TEST(Correspondence, IsNotFoundBehindOtherObjectsOrAtOtherDepths) {
    ViewSurfaces source = wall(0.0F, 2.0F);
    source.object[16 * 3 + 9] = 8U; // one pixel of another object spoils the four places between it and its neighbours
    const Correspondence map = find_correspondence(wall(0.0F, 2.0F), source);
    EXPECT_FALSE(map.place[16 * 3 + 9]);
    EXPECT_TRUE(map.place[16 * 3 + 12]);
    EXPECT_EQ(visible_count(find_correspondence(wall(0.0F, 2.0F), wall(0.0F, 1.97F))), 0U); // 1.5 % nearer: in front
    EXPECT_EQ(visible_count(find_correspondence(wall(0.0F, 2.0F), wall(0.0F, 1.99F))), 16U * 8U);
    EXPECT_EQ(visible_count(find_correspondence(wall(0.0F, 2.0F), wall(0.0F, kInfinity))), 0U);
}

TEST(Correspondence, FollowsObjectsThatMoved) {
    std::vector<glm::mat4> source_from_target(8, glm::mat4(1.0F));
    source_from_target[7] = glm::translate(glm::mat4(1.0F), {-0.06F, 0.0F, 0.0F}); // −3 px at 2 m
    const Correspondence map = find_correspondence(wall(0.0F, 2.0F), wall(0.0F, 2.0F), source_from_target);
    ASSERT_TRUE(map.place[16 * 3 + 8]);
    EXPECT_NEAR(map.place[16 * 3 + 8]->x, 8.5F - 3.0F, 1e-4F);
    EXPECT_FALSE(map.place[16 * 3 + 1]); // came from outside the image
}

TEST(Correspondence, TakesTheSkyAsInfinitelyFar) {
    const Correspondence moved = find_correspondence(wall(0.5F, kInfinity), wall(0.0F, kInfinity));
    EXPECT_EQ(visible_count(moved), 16U * 8U);
    EXPECT_NEAR(moved.place[16 * 3 + 5]->x, 5.5F, 1e-4F);
    ViewSurfaces turned = wall(0.0F, kInfinity);
    turned.camera.world_from_camera = glm::rotate(glm::mat4(1.0F), glm::radians(180.0F), {0.0F, 1.0F, 0.0F});
    EXPECT_EQ(visible_count(find_correspondence(wall(0.0F, kInfinity), turned)), 0U);
}

TEST(Correspondence, RefusesViewsThatDoNotMatch) {
    ViewSurfaces incomplete = wall(0.0F, 2.0F);
    incomplete.object.pop_back();
    EXPECT_THROW(find_correspondence(incomplete, wall(0.0F, 2.0F)), std::logic_error);
    EXPECT_THROW(find_correspondence(wall(0.0F, 2.0F), wall(0.0F, 2.0F, 17)), std::logic_error);
}

TEST(WarpedDifference, IsTheMeanOverVisiblePixels) {
    const RgbF32 target{3, 1, {{0.5F, 0.5F, 0.5F}, {0.2F, 0.4F, 0.6F}, {1.0F, 1.0F, 1.0F}}};
    const RgbF32 source{3, 1, {{0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F}, {0.0F, 0.0F, 0.0F}}};
    Correspondence map{3, 1, {}};
    // A quarter of the way from the first to the second pixel: 0.25; exactly the second pixel: 1; and one not visible.
    map.place = {glm::vec2(0.75F, 0.5F), glm::vec2(1.5F, 0.5F), std::nullopt};
    // (3 · |0.5 − 0.25| + |0.2 − 1| + |0.4 − 1| + |0.6 − 1|) / 6 = 2.55 / 6
    EXPECT_NEAR(warped_difference(target, source, map).value(), 0.425, 1e-7);
    map.place.assign(3, std::nullopt);
    EXPECT_FALSE(warped_difference(target, source, map));
}

// Errors that stick to the surface, as those of a lamp that is too dark, do not make views inconsistent; errors that
// stick to the screen do.
TEST(WarpedDifference, OfErrorsTellsConsistentOnesFromOthers) {
    const ViewSurfaces left = wall(0.0F, 2.5F); // 2 px of disparity
    const ViewSurfaces right = wall(0.05F, 2.5F);
    RgbF32 reference{16, 8, {}};
    reference.pixels.assign(16 * 8, glm::vec3(0.5F));
    const auto with_stripe = [&](std::size_t column) {
        RgbF32 image = reference;
        for (std::size_t y = 0; y < 8; ++y) {
            image.pixels[16 * y + column] = glm::vec3(0.25F);
        }
        return error_image(image, reference);
    };
    const Correspondence map = find_correspondence(right, left);
    EXPECT_NEAR(warped_difference(with_stripe(6), with_stripe(8), map).value(), 0.0, 1e-5);
    // 14 columns are visible; the stripe of either view differs: 2 · 0.25 / 14.
    EXPECT_NEAR(warped_difference(with_stripe(8), with_stripe(8), map).value(), 0.5 / 14.0, 1e-5);
}

} // namespace
} // namespace fieldcast::image
