// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_file.h"
#include "core/image/metrics.h"
#include "tests/render/render_test.h"

namespace fieldcast::render {
namespace {

/// Made by tools/make_cornell_reference.py with 4096 samples per pixel.
constexpr const char* kReference = "tests/data/render/cornell_mitsuba.exr";
constexpr std::uint32_t kSize = 48;
constexpr std::uint32_t kBlock = 4;

using CornellTest = RenderTest;

TEST_F(CornellTest, AgreesWithMitsuba) {
    const image::RgbF32 reference = image::read_rgb_f32(kReference, {});
    ASSERT_EQ(reference.width_px, kSize);
    const PathTracing options{.samples = 32, .renders = 8};
    const Estimate image = path_trace(cornell_box(), cornell_camera(kSize), options);
    Estimate expected{kSize, kSize, {}, {}};
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        expected.mean.emplace_back(reference.pixels[i]);
        // The reference has 16 times as many samples of equal noise.
        expected.variance.push_back(image.variance[i] / 16.0);
    }

    // Blocks: 432 comparisons at 5 standard errors give a false alarm once in 4000 runs with other seeds. 1 % allows
    // for the metal, because Mitsuba's lacks multiple scattering, which also affects the light in the room.
    double worst = 0.0;
    for (std::uint32_t y = 0; y < kSize; y += kBlock) {
        for (std::uint32_t x = 0; x < kSize; x += kBlock) {
            const Average ours = average(image, x, y, kBlock, kBlock);
            const Average theirs = average(expected, x, y, kBlock, kBlock);
            for (int c = 0; c < 3; ++c) {
                const double error = std::hypot(ours.standard_error[c], theirs.standard_error[c]);
                const double excess = std::abs(ours.mean[c] - theirs.mean[c]) - 0.01 * theirs.mean[c];
                worst = std::max(worst, excess / error);
                EXPECT_LT(excess, 5.0 * error) << "block " << x << " " << y << " channel " << c << ": " << ours.mean[c]
                                               << " instead of " << theirs.mean[c];
            }
        }
    }

    // Whole image: noise must explain its distance from the reference. The variances of 8 renders are known within
    // 53 %/√6912 overall; the factor 1.2 allows for heavy tails of caustics from the metal.
    image::RgbF32 mean{kSize, kSize, {}};
    double expected_error = 0.0;
    for (std::size_t i = 0; i < image.mean.size(); ++i) {
        mean.pixels.emplace_back(image.mean[i]);
        for (int c = 0; c < 3; ++c) {
            const double variance = image.variance[i][c] + expected.variance[i][c];
            expected_error += variance / (expected.mean[i][c] * expected.mean[i][c] + 0.01) / 3.0;
        }
    }
    expected_error /= static_cast<double>(image.mean.size());
    const double measured = image::relative_mse(mean, reference);
    EXPECT_LT(measured, 1.2 * expected_error);
    const Average whole = average(image);
    const Average whole_reference = average(expected);
    EXPECT_NEAR(whole.mean.y, whole_reference.mean.y, 5.0 * whole.standard_error.y + 0.003 * whole_reference.mean.y);
    RecordProperty("worst_block_standard_errors", std::to_string(worst));
    RecordProperty("relative_mse", std::to_string(measured) + " noise " + std::to_string(expected_error));
    RecordProperty("mean", std::to_string(whole.mean.y) + " reference " + std::to_string(whole_reference.mean.y));
}

} // namespace
} // namespace fieldcast::render
