// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/scores.h"

#include "core/image/transfer.h"

#include <cmath>
#include <gtest/gtest.h>

namespace fieldcast::bench {
namespace {

constexpr std::uint32_t kWidth = 80;
constexpr std::uint32_t kHeight = 70;

image::RgbF32 grey(float linear) {
    return {kWidth, kHeight, std::vector<glm::vec3>(kWidth * kHeight, glm::vec3(linear))};
}

std::vector<bool> mask_of(std::initializer_list<std::size_t> pixels) {
    std::vector<bool> mask(kWidth * kHeight);
    for (const std::size_t pixel : pixels) {
        mask[pixel] = true;
    }
    return mask;
}

/// 1e-6: linear radiance and displayed values are single precision.
constexpr double kTolerance = 1e-6;

TEST(Scores, TellPartsOfPicturesApart) {
    image::RgbF32 picture = grey(0.0F);
    const std::size_t hole = 35 * kWidth + 40;  // in the middle, which is 16 × 6 pixels beside the border
    const std::size_t mover = 34 * kWidth + 39; // likewise
    picture.pixels[hole] = glm::vec3(0.5F);     // display-referred 1 at exposure 2
    picture.pixels[mover].g = 0.5F;
    picture.pixels[0] = glm::vec3(0.5F); // in the border
    Scores scores;
    scores.add({11, {}}, picture, noiseless(grey(0.0F)), 2.0F, {mask_of({hole}), mask_of({mover, 5})});
    const auto json = scores.to_json();
    const auto expect = [&](const char* key, double squared, double pixels) {
        EXPECT_NEAR(json[key].get<double>(), std::sqrt(squared / (3.0 * pixels)), kTolerance) << key;
    };
    constexpr double kPixels = kWidth * kHeight;
    expect("rmse", 7.0, kPixels);
    expect("rmse_holes", 3.0, 1.0);
    expect("rmse_reused", 4.0, kPixels - 1.0);
    expect("rmse_border", 3.0, kPixels - 16.0 * 6.0);
    expect("rmse_moving", 1.0, 2.0);
    // Exposed values are 1 and 0: 1² / (0 + 0.01) for each of seven channels.
    EXPECT_NEAR(json["relative_mse"].get<double>(), 700.0 / (3.0 * kPixels), kTolerance);
}

TEST(Scores, AreMeansOverPictures) {
    Scores scores;
    scores.add({11, {}}, grey(0.5F), noiseless(grey(0.5F)), 1.0F, {});
    scores.add({23, {2, 2}}, grey(0.5F), noiseless(grey(0.0F)), 1.0F, {});
    const double difference = static_cast<double>(image::srgb_from_linear(0.5F));
    const auto json = scores.to_json();
    EXPECT_NEAR(json["rmse"].get<double>(), difference / 2.0, kTolerance);
    EXPECT_NEAR(json["rmse_reused"].get<double>(), difference / std::sqrt(2.0), kTolerance); // over all pixels
    EXPECT_TRUE(json["rmse_holes"].is_null());
    EXPECT_TRUE(json["rmse_moving"].is_null());
    ASSERT_EQ(scores.pictures().size(), 2U);
    EXPECT_EQ(scores.pictures()[1].id.frame, 23U);
    EXPECT_EQ(scores.pictures()[0].rmse, 0.0);
    EXPECT_NEAR(scores.pictures()[0].ssim, 1.0, 1e-12);
}

TEST(Scores, OfNothingAreNull) {
    const auto json = Scores().to_json();
    EXPECT_EQ(json.size(), 9U);
    for (const auto& [key, value] : json.items()) {
        EXPECT_TRUE(value.is_null()) << key;
    }
}

TEST(Spread, IsThatOfAWholePopulation) {
    const Spread spread = spread_of({2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0});
    EXPECT_DOUBLE_EQ(spread.mean, 5.0);
    EXPECT_EQ(spread.min, 2.0);
    EXPECT_EQ(spread.max, 9.0);
    EXPECT_DOUBLE_EQ(spread.deviation, 2.0);
    EXPECT_THROW(spread_of({}), std::logic_error);
}

} // namespace
} // namespace fieldcast::bench
