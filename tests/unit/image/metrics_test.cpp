// SPDX-License-Identifier: Apache-2.0
#include "core/image/metrics.h"

#include "core/image/transfer.h"
#include "tests/unit/image/test_image.h"

#include <cmath>
#include <limits>
#include <random>

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

/// `clean` with noise in each channel that is uniform and has this standard deviation.
RgbF32 with_noise(const RgbF32& clean, float deviation, std::uint32_t seed) {
    RgbF32 image = clean;
    std::mt19937 generator(seed); // whose numbers the standard prescribes; distributions are not
    for (glm::vec3& pixel : image.pixels) {
        for (int channel = 0; channel < 3; ++channel) {
            const float uniform = static_cast<float>(generator()) / 4294967296.0F - 0.5F;
            pixel[channel] += std::sqrt(12.0F) * deviation * uniform;
        }
    }
    return image;
}

// What an image scores against a noisy reference and against its two halves, compared with the clean one. Noise of 0.03
// in the mean is three times that of references of 1024 samples. The sums run over 256×256 pixels: products of two
// halves' noise have a deviation of 0.0018 per pixel and channel, hence 4e-6 in their mean, a hundredth of the squared
// RMSE, and 0.005 of the RMSE. SSIM is bent by the covariance that noise has within one window, of either sign and cut
// off at 0.
TEST(Metrics, KnowWhatTheyWouldBeWithoutNoiseOfTheReference) {
    RgbF32 clean{256, 256, {}};
    RgbF32 image{256, 256, {}};
    for (std::uint32_t y = 0; y < 256; ++y) {
        for (std::uint32_t x = 0; x < 256; ++x) {
            const float edge = (x / 16 + y / 16) % 2 == 1 ? 0.3F : 0.6F;
            clean.pixels.emplace_back(edge);
            image.pixels.emplace_back(edge + 0.02F * std::sin(0.5F * static_cast<float>(x + 2 * y)));
        }
    }
    const float half_noise = 0.03F * std::sqrt(2.0F);
    const RgbF32 first = with_noise(clean, half_noise, 1);
    const RgbF32 second = with_noise(clean, half_noise, 2);
    RgbF32 mean = first;
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        mean.pixels[i] = (first.pixels[i] + second.pixels[i]) / 2.0F;
    }
    const double true_rmse = rmse(image, clean);
    const double true_ssim = ssim(image, clean);
    EXPECT_GT(rmse(image, mean), 1.5 * true_rmse);
    EXPECT_LT(ssim(image, mean), true_ssim - 0.08);
    EXPECT_NEAR(rmse_without_noise(image, first, second), true_rmse, 0.015 * true_rmse); // three deviations
    EXPECT_NEAR(ssim_without_noise(image, first, second), true_ssim, 0.02);
    EXPECT_NEAR(rmse_without_noise(image, clean, clean), true_rmse, 1e-9);
    EXPECT_NEAR(ssim_without_noise(image, clean, clean), true_ssim, 1e-12);
    EXPECT_EQ(rmse_without_noise(clean, clean, second), 0.0);
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
