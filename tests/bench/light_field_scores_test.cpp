// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/light_field_scores.h"

#include "core/image/transfer.h"

#include <cmath>
#include <gtest/gtest.h>

namespace fieldcast::bench {
namespace {

constexpr std::uint32_t kWidth = 32;
constexpr std::uint32_t kHeight = 16;
constexpr float kDepth_m = 2.5F;
constexpr float kSpacing_m = 0.05F;
constexpr float kFocal_px = 100.0F; // disparity 2 px per step

/// 2×2 views of a striped wall, as their references show it.
struct Wall {
    ViewGrid grid;
    LightFieldPictures pictures;
    Wall();
};

image::RgbF32 stripes(std::int32_t offset_px) {
    image::RgbF32 image{kWidth, kHeight, {}};
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
        const std::int32_t x = static_cast<std::int32_t>(i % kWidth) + offset_px;
        image.pixels.emplace_back(0.25F + 0.5F * static_cast<float>((x + 64) / 4 % 2));
    }
    return image;
}

Wall::Wall() {
    grid.rows = grid.cols = 2;
    grid.geometry.spacing_m = glm::vec2(kSpacing_m);
    Camera source = make_camera(glm::mat4(1.0F), 2.0F * std::atan(0.5F * kHeight / kFocal_px), kWidth, kHeight);
    for (const LatticePosition position : lattice_positions(grid)) {
        const Camera camera = view_camera(source, grid.geometry, position, vertical_fov(source), kWidth, kHeight);
        pictures.surfaces.push_back(
            {camera, std::vector<float>(kWidth * kHeight, kDepth_m), std::vector<std::uint32_t>(kWidth * kHeight, 0)});
        // What lies at x in the source lies 2 px further left one step to the right.
        pictures.references.push_back(stripes(2 * static_cast<std::int32_t>(position.col())));
    }
    pictures.views = pictures.references;
}

TEST(LightFieldScores, OfReferencesArePerfect) {
    const Wall wall;
    const auto json = light_field_scores(wall.grid, wall.pictures, 1.0F);
    EXPECT_EQ(json["angular_error"], 0.0);
    EXPECT_NEAR(json["epi_ssim"].get<double>(), 1.0, 1e-12);
    EXPECT_EQ(json["refocus_rmse"], 0.0);
    ASSERT_EQ(json["refocus"].size(), 5U);
    EXPECT_NEAR(json["refocus"][0]["depth_m"].get<double>(), 2.5, 1e-6);
    ASSERT_EQ(json["views"].size(), 4U);
    EXPECT_EQ(json["views"][1]["col"], 1);
    EXPECT_EQ(json["views"][2]["row"], 1);
    EXPECT_EQ(json["rmse"]["max"], 0.0);
}

// A wall that is too dark everywhere is wrong, but alike in all views.
TEST(LightFieldScores, ErrorsThatStickToSurfacesAreConsistent) {
    Wall wall;
    for (image::RgbF32& view : wall.pictures.views) {
        for (glm::vec3& pixel : view.pixels) {
            pixel = glm::vec3(pixel.r > 0.5F ? 0.5F : 0.25F);
        }
    }
    const auto json = light_field_scores(wall.grid, wall.pictures, 1.0F);
    EXPECT_NEAR(json["angular_error"].get<double>(), 0.0, 1e-4); // places are rounded by 1e-5 px
    EXPECT_GT(json["rmse"]["min"].get<double>(), 0.05);
}

TEST(LightFieldScores, ViewsThatDifferAreNot) {
    Wall wall;
    wall.pictures.views[3] = stripes(64); // shows the wall where the source shows it: no parallax
    const auto json = light_field_scores(wall.grid, wall.pictures, 1.0F);
    // Two of the four pairs of neighbours differ, in half of the pixels by the contrast of the stripes.
    const double contrast = static_cast<double>(image::srgb_from_linear(0.75F) - image::srgb_from_linear(0.25F));
    EXPECT_NEAR(json["angular_error"].get<double>(), 0.25 * contrast, 0.05 * contrast); // 30 columns, not whole stripes
    EXPECT_LT(json["epi_ssim"].get<double>(), 0.9);
    EXPECT_EQ(json["views"][0]["rmse"], 0.0);
    EXPECT_EQ(json["rmse"]["max"], json["views"][3]["rmse"]);
    // Focused on the wall, the wrong view is a quarter of the light, in linear values: where only it is bright (0.25 +
    // 0.125) or dark. Elsewhere all agree.
    const double wrong = static_cast<double>(image::srgb_from_linear(0.375F) - image::srgb_from_linear(0.25F));
    const double also = static_cast<double>(image::srgb_from_linear(0.75F) - image::srgb_from_linear(0.625F));
    EXPECT_NEAR(json["refocus"][0]["rmse"].get<double>(), std::sqrt((wrong * wrong + also * also) / 4.0),
                0.1 * wrong); // columns at the right, which fewer views show
}

TEST(LightFieldScores, NeedAllViews) {
    Wall wall;
    wall.pictures.references.pop_back();
    EXPECT_THROW(light_field_scores(wall.grid, wall.pictures, 1.0F), std::logic_error);
}

} // namespace
} // namespace fieldcast::bench
