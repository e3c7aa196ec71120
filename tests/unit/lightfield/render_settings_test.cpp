// SPDX-License-Identifier: Apache-2.0
#include "core/lightfield/presets.h"

#include <gtest/gtest.h>

namespace fieldcast {
namespace {

TEST(HoleFilling, IsReadFromWords) {
    EXPECT_EQ(parse_hole_filling("all", 4, 5), (HoleFilling{true, true, 4, 5, true, true}));
    EXPECT_EQ(parse_hole_filling("none", 4, 5), HoleFilling::path_traced());
    EXPECT_EQ(parse_hole_filling("cascade", 4, 5), (HoleFilling{false, false, 4, 5, false, false}));
    EXPECT_EQ(parse_hole_filling("denoise,previous", 4, 5), (HoleFilling{true, false, 0, 0, false, true}));
    for (const char* const text : {"", "everything", "cascade,", ",cascade", "all,none"}) {
        EXPECT_EQ(parse_hole_filling(text, 4, 5), std::nullopt) << text;
    }
}

TEST(Presets, DifferInWhatTheyAreNamedFor) {
    const auto ours = find_preset("default", 6, 6);
    const auto svgf = find_preset("svgf", 6, 6);
    const auto bmfr = find_preset("bmfr", 6, 6);
    const auto reprojected = find_preset("reprojected", 6, 6);
    ASSERT_TRUE(ours && svgf && bmfr && reprojected);
    EXPECT_EQ(ours->settings.holes, parse_hole_filling("all", 6, 6));
    EXPECT_TRUE(ours->has_guard_band);
    EXPECT_EQ(svgf->settings.holes, HoleFilling::path_traced());
    EXPECT_FALSE(svgf->has_guard_band);
    EXPECT_EQ(reprojected->settings.denoiser, Denoiser::kNone);
    EXPECT_EQ(ours->settings.indirect_clamp, svgf->settings.indirect_clamp); // the same input
    EXPECT_EQ(bmfr->settings.denoiser, Denoiser::kBmfr);
    EXPECT_EQ(bmfr->settings.max_bounces, 8U);
    EXPECT_EQ(bmfr->settings.temporal_alpha, 0.2F);
    RenderSettings other_denoiser = svgf->settings;
    other_denoiser.denoiser = Denoiser::kBmfr;
    EXPECT_TRUE(bmfr->settings == other_denoiser && bmfr->has_guard_band == svgf->has_guard_band);
    EXPECT_FALSE(find_preset("best", 6, 6));
}

TEST(Presets, AreChangedByWords) {
    const auto changed = find_preset("default/sobol/no-reflections", 6, 6);
    ASSERT_TRUE(changed);
    RenderSettings expected = find_preset("default", 6, 6)->settings;
    EXPECT_EQ(expected.sampler, Sampler::kZSobol);
    EXPECT_TRUE(expected.reflections);
    expected.sampler = Sampler::kSobol;
    expected.reflections = false;
    EXPECT_TRUE(changed->settings == expected && changed->has_guard_band);
    EXPECT_FALSE(find_preset("default/no-guard-band", 6, 6)->has_guard_band);
    EXPECT_EQ(find_preset("default/traced-holes", 6, 6)->settings.holes, HoleFilling::path_traced());
    EXPECT_EQ(find_preset("default/no-candidates", 6, 6)->settings.light_sampling, LightSampling::plain());
    EXPECT_TRUE(find_preset("default", 6, 6)->settings.light_sampling.each_kind);
    EXPECT_EQ(find_preset("default/one-light-sample", 6, 6)->settings.light_sampling, (LightSampling{4, false}));
    EXPECT_TRUE(find_preset("default", 6, 6)->settings.history_light);
    EXPECT_FALSE(find_preset("default/no-history-light", 6, 6)->settings.history_light);
    EXPECT_FALSE(find_preset("paper", 6, 6)->settings.history_light);
    EXPECT_EQ(find_preset("svgf/z-sobol", 6, 6)->settings.sampler, Sampler::kZSobol);
    EXPECT_FALSE(find_preset("default/better", 6, 6));
}

TEST(Presets, OfThePaperAreSvgfButForTheirRoute) {
    const RenderSettings svgf = find_preset("svgf", 6, 6)->settings;
    RenderSettings paper = find_preset("paper", 6, 6)->settings;
    RenderSettings red = find_preset("paper-red", 6, 6)->settings;
    EXPECT_TRUE(paper.accumulate_views);
    EXPECT_EQ(red.denoised_images, DenoisedImages::kViews);
    EXPECT_FALSE(find_preset("paper", 6, 6)->has_guard_band);
    paper.accumulate_views = false;
    red.denoised_images = DenoisedImages::kSource;
    EXPECT_EQ(paper, svgf);
    EXPECT_EQ(red, svgf);
}

TEST(Presets, RedIsOursButForItsRoute) {
    RenderSettings red = find_preset("denoised-views", 6, 6)->settings;
    EXPECT_EQ(red.denoised_images, DenoisedImages::kViews);
    red.denoised_images = DenoisedImages::kSource;
    EXPECT_EQ(red, find_preset("default", 6, 6)->settings);
}

} // namespace
} // namespace fieldcast
