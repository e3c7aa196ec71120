// SPDX-License-Identifier: Apache-2.0
#include "core/image/metrics.h"

#include "core/image/transfer.h"
#include "tests/unit/image/test_image.h"

#include <cmath>
#include <limits>

namespace fieldcast::image {
namespace {

constexpr std::uint32_t kWidth = 48;
constexpr std::uint32_t kHeight = 32;

struct Pair {
    RgbF32 reference{kWidth, kHeight, {}};
    RgbF32 image{kWidth, kHeight, {}};
};

/// Ramps on a checkerboard against a darker, noisy copy; multiples of 1/256, so exact in float.
Pair synthetic_pair() {
    Pair pair;
    for (std::uint32_t y = 0; y < kHeight; ++y) {
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            glm::vec3 reference;
            glm::vec3 image;
            for (std::uint32_t c = 0; c < 3; ++c) {
                std::uint32_t base = (x * 4 + y * (c + 1) * 2) % 256;
                base = (x / 8 + y / 8) % 2 == 1 ? base / 2 : base;
                reference[static_cast<int>(c)] = static_cast<float>(base) / 256.0F;
                image[static_cast<int>(c)] = static_cast<float>(base * 3 / 4 + test::hash_byte(x, y, c) / 4) / 256.0F;
            }
            pair.reference.pixels.push_back(reference);
            pair.image.pixels.push_back(image);
        }
    }
    return pair;
}

// Expected numbers from scikit-image 0.26.0 and numpy in double precision on the same pair:
// structural_similarity(luma, luma, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1.0) with
// luma = (0.2126, 0.7152, 0.0722)·RGB, peak_signal_noise_ratio(data_range=1.0), and the formulas of the header.
// The sums here differ by rounding only, hence 1e-9.
TEST(Metrics, AgreeWithScikitImage) {
    const Pair pair = synthetic_pair();
    EXPECT_NEAR(ssim(pair.image, pair.reference), 0.8145249604301487, 1e-9);
    EXPECT_NEAR(rmse(pair.image, pair.reference), 0.09669984207118508, 1e-9);
    EXPECT_NEAR(psnr_db(pair.image, pair.reference), 20.29148470400054, 1e-9);
    EXPECT_NEAR(relative_mse(pair.image, pair.reference), 0.23172194303467128, 1e-9);
}

TEST(Metrics, EqualImagesArePerfect) {
    const Pair pair = synthetic_pair();
    EXPECT_NEAR(ssim(pair.image, pair.image), 1.0, 1e-12);
    EXPECT_EQ(rmse(pair.image, pair.image), 0.0);
    EXPECT_EQ(relative_mse(pair.image, pair.image), 0.0);
    EXPECT_EQ(psnr_db(pair.image, pair.image), std::numeric_limits<double>::infinity());
}

TEST(Metrics, RefuseImagesThatDoNotMatch) {
    const Pair pair = synthetic_pair();
    RgbF32 narrow = pair.image;
    narrow.width_px = 47;
    EXPECT_THROW(rmse(narrow, pair.reference), std::logic_error);
    const RgbF32 tiny{10, 10, std::vector<glm::vec3>(100)};
    EXPECT_THROW(ssim(tiny, tiny), std::logic_error);
    const RgbF32 window{11, 11, std::vector<glm::vec3>(121)};
    EXPECT_EQ(ssim(window, window), 1.0);
}

TEST(Metrics, PropagateNan) {
    Pair pair = synthetic_pair();
    pair.image.pixels[700].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isnan(rmse(pair.image, pair.reference)));
    EXPECT_TRUE(std::isnan(ssim(pair.image, pair.reference)));
}

TEST(DisplayImage, ClampsExposesAndEncodes) {
    const RgbF32 linear{1, 1, {{0.25F, 4.0F, -1.0F}}};
    EXPECT_EQ(display_image(linear, 2.0F).pixels[0], glm::vec3(srgb_from_linear(0.5F), 1.0F, 0.0F));
    EXPECT_EQ(display_image(test::flat_plane(1, 1, 255, 51, 0)).pixels[0], glm::vec3(1.0F, 0.2F, 0.0F));
}

TEST(Srgb, MatchesTheStandardAndInverts) {
    EXPECT_NEAR(srgb_from_linear(0.5F), 0.735357F, 1e-5F); // IEC 61966-2-1
    EXPECT_NEAR(srgb_from_linear(0.001F), 0.01292F, 1e-6F);
    EXPECT_EQ(srgb_from_linear(0.0F), 0.0F);
    EXPECT_EQ(srgb_from_linear(1.0F), 1.0F);
    EXPECT_TRUE(std::isnan(srgb_from_linear(std::numeric_limits<float>::quiet_NaN())));
    for (int i = 0; i < 256; ++i) {
        const float srgb = static_cast<float>(i) / 255.0F;
        EXPECT_NEAR(srgb_from_linear(linear_from_srgb(srgb)), srgb, 2e-6F) << i;
    }
}

} // namespace
} // namespace fieldcast::image
