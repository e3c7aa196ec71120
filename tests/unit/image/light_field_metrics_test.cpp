// SPDX-License-Identifier: Apache-2.0
// Metrics of whole light fields and of sequences: epipolar slices, refocused images, flicker.
#include "core/image/epipolar.h"
#include "core/image/flicker.h"
#include "core/image/refocus.h"
#include "tests/unit/image/test_image.h"

#include <cmath>
#include <limits>

namespace fieldcast::image {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct LineOfViews {
    std::vector<RgbF32> references;
    std::vector<RgbF32> images;
};

/// Six views of 24×13 pixels: a ramp that moves by two pixels from view to view, against a darker, noisy copy.
LineOfViews synthetic_line() {
    LineOfViews line;
    for (std::uint32_t u = 0; u < 6; ++u) {
        line.references.push_back({24, 13, {}});
        line.images.push_back({24, 13, {}});
        for (std::uint32_t i = 0; i < 24 * 13; ++i) {
            const std::uint32_t x = i % 24;
            const std::uint32_t y = i / 24;
            glm::vec3 reference;
            glm::vec3 image;
            for (std::uint32_t c = 0; c < 3; ++c) {
                const std::uint32_t base = ((x + 2 * u) * 8 + y * (c + 1) * 5) % 256;
                reference[static_cast<int>(c)] = static_cast<float>(base) / 256.0F;
                image[static_cast<int>(c)] =
                    static_cast<float>(base * 3 / 4 + test::hash_byte(x, y, 3 * u + c) / 4) / 256.0F;
            }
            line.references.back().pixels.push_back(reference);
            line.images.back().pixels.push_back(image);
        }
    }
    return line;
}

// Expected numbers from scipy 1.17.1: the five window means with ndimage.correlate1d, along the pixels where the window
// lies inside, along the views with zeros beyond the ends, divided by the same filter of ones; in double precision.
TEST(EpiSsim, AgreesWithScipy) {
    const LineOfViews line = synthetic_line();
    EXPECT_NEAR(epi_ssim(line.images, line.references, ViewLine::kRow), 0.8209913658697949, 1e-9);
    EXPECT_NEAR(epi_ssim(line.images, line.references, ViewLine::kColumn), 0.8444234315333661, 1e-9);
}

TEST(EpiSsim, NoticesViewsThatAreExchanged) {
    LineOfViews line = synthetic_line();
    EXPECT_NEAR(epi_ssim(line.references, line.references, ViewLine::kRow), 1.0, 1e-12);
    std::vector<RgbF32> exchanged = line.references;
    std::swap(exchanged[2], exchanged[3]);
    EXPECT_LT(epi_ssim(exchanged, line.references, ViewLine::kRow), 0.99);
}

TEST(EpiSsim, RefusesLinesThatDoNotMatch) {
    const LineOfViews line = synthetic_line();
    const std::span all(line.images);
    EXPECT_THROW(epi_ssim(all, std::span(line.references).first(5), ViewLine::kRow), std::logic_error);
    EXPECT_THROW(epi_ssim(all.first(1), all.first(1), ViewLine::kRow), std::logic_error);
    const std::vector<RgbF32> narrow(2, RgbF32{10, 11, std::vector<glm::vec3>(110)});
    EXPECT_THROW(epi_ssim(narrow, narrow, ViewLine::kRow), std::logic_error);
    EXPECT_EQ(epi_ssim(narrow, narrow, ViewLine::kColumn), 1.0);
}

/// One row of grey pixels.
RgbF32 grey_row(const std::vector<float>& values) {
    RgbF32 image{static_cast<std::uint32_t>(values.size()), 1, {}};
    for (const float value : values) {
        image.pixels.emplace_back(value);
    }
    return image;
}

std::vector<float> reds(const RgbF32& image) {
    std::vector<float> values;
    for (const glm::vec3& pixel : image.pixels) {
        values.push_back(pixel.r);
    }
    return values;
}

TEST(Refocus, BringsPointsOfOneDepthTogether) {
    const RgbF32 middle = grey_row({0, 0, 1, 0, 0, 0});
    const RgbF32 right = grey_row({1, 0, 0, 0, 0, 0}); // the point lies 2 px further left, seen from the right
    const std::array sharp{ShiftedView{&middle, {0, 0}}, ShiftedView{&right, {-2, 0}}};
    EXPECT_EQ(reds(refocus(sharp)), (std::vector<float>{0, 0, 1, 0, 0, 0}));
    const std::array blurred{ShiftedView{&middle, {0, 0}}, ShiftedView{&right, {0, 0}}};
    EXPECT_EQ(reds(refocus(blurred)), (std::vector<float>{0.5F, 0, 0.5F, 0, 0, 0}));
}

TEST(Refocus, TakesOnlyViewsThatShowAPixel) {
    const RgbF32 one = grey_row({0.25F, 0.25F, 0.25F});
    const RgbF32 other = grey_row({0.75F, 0.5F, 0.25F});
    // Half a pixel to the right: 0.625, 0.375, and nothing beyond the last centre.
    const std::array views{ShiftedView{&one, {0, 0}}, ShiftedView{&other, {0.5F, 0}}};
    EXPECT_EQ(reds(refocus(views)), (std::vector<float>{0.4375F, 0.3125F, 0.25F}));
}

TEST(FocalDepths, AreEquallySpacedInInverseDepth) {
    std::vector<float> depth_m;
    for (int i = 1; i <= 101; ++i) {
        depth_m.push_back(1.0F / static_cast<float>(i)); // inverse depths 1 … 101, 5 % quantile 6, 95 % quantile 96
    }
    const std::vector<float> depths = focal_depths(depth_m, 5);
    ASSERT_EQ(depths.size(), 5U);
    const std::array<float, 5> inverse{6.0F, 28.5F, 51.0F, 73.5F, 96.0F};
    for (std::size_t i = 0; i < depths.size(); ++i) {
        EXPECT_NEAR(1.0F / depths[i], inverse[i], 1e-3F);
    }
    EXPECT_TRUE(std::isinf(focal_depths({kInfinity, kInfinity, 2.0F}, 3).front()));
}

TEST(Flicker, IsTheMeanDeviationOverFrames) {
    Flicker flicker;
    // Standard deviations (n − 1): red of the first pixel 0.1 (0.4, 0.5, 0.6), blue of the second √(0.08/2) = 0.2.
    flicker.add({2, 1, {{0.4F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.1F}}});
    flicker.add({2, 1, {{0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.3F}}});
    flicker.add({2, 1, {{0.6F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F}}});
    EXPECT_NEAR(flicker.deviation(), (0.1 + 0.2) / 6.0, 1e-8);
}

TEST(Flicker, NeedsTwoFramesOfOneSize) {
    Flicker flicker;
    flicker.add({2, 1, std::vector<glm::vec3>(2)});
    EXPECT_THROW(flicker.deviation(), std::logic_error);
    EXPECT_THROW(flicker.add({1, 1, std::vector<glm::vec3>(1)}), std::logic_error);
    flicker.add({2, 1, std::vector<glm::vec3>(2)});
    EXPECT_EQ(flicker.deviation(), 0.0);
}

} // namespace
} // namespace fieldcast::image
