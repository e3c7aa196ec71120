// SPDX-License-Identifier: Apache-2.0
#include "core/wire/convert.h"

#include "tests/wire/test_frames.h"

#include <array>
#include <cmath>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldcast::wire {
namespace {

using namespace fieldcast::testing;
using ::testing::HasSubstr;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

v1::FrameHeader valid_header() {
    v1::FrameHeader message;
    to_proto(test_header(7), message);
    return message;
}

TEST(Convert, FrameHeaderSurvives) {
    const FrameHeader header = test_header(7);
    const auto back = from_proto(valid_header(), 7);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_TRUE(*back == header);
    const auto defaults = from_proto([] {
        v1::FrameHeader message;
        to_proto(FrameHeader{}, message);
        return message;
    }(), 0);
    ASSERT_TRUE(defaults) << defaults.error().message;
    EXPECT_TRUE(*defaults == FrameHeader{});
}

TEST(Convert, SourcesOfAFrameSurvive) {
    FrameHeader header = test_header(7);
    header.applied_pose = {.lease = 3, .sequence = 1ULL << 40U, .client_time_ns = -5};
    header.source_positions = {{-4, -4}, {6, 5}};
    header.source_geometry = {{0.02F, 0.03F}, 2.5F};
    v1::FrameHeader message;
    to_proto(header, message);
    const auto back = from_proto(message, 7);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_TRUE(*back == header);
    message.clear_sources(); // as senders wrote before there were several
    const auto one = from_proto(message, 7);
    ASSERT_TRUE(one) << one.error().message;
    EXPECT_EQ(one->source_positions, FrameHeader{}.source_positions);
}

TEST(Convert, DenoisersKeepTheirNumbers) {
    constexpr std::array kNumbers{std::pair(Denoiser::kNone, 1), std::pair(Denoiser::kSvgf, 2),
                                  std::pair(Denoiser::kSvgfPlus, 3), std::pair(Denoiser::kBmfr, 4)};
    for (const auto& [denoiser, number] : kNumbers) {
        RenderSettings settings;
        settings.denoiser = denoiser;
        v1::RenderSettings message;
        to_proto(settings, message);
        EXPECT_EQ(static_cast<int>(message.denoiser()), number);
        const auto back = from_proto(message);
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->denoiser, denoiser);
    }
}

TEST(Convert, RouteOfAFrameSurvives) {
    FrameHeader header = test_header(7);
    header.settings.denoised_images = DenoisedImages::kViews;
    header.settings.accumulate_views = true;
    header.settings.history_light = true;
    v1::FrameHeader message;
    to_proto(header, message);
    const auto back = from_proto(message, 7);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->settings, header.settings);
    message.mutable_settings()->clear_denoised_images(); // as senders wrote before there were two
    message.mutable_settings()->clear_accumulate_views();
    message.mutable_settings()->clear_history_light();
    const auto old = from_proto(message, 7);
    ASSERT_TRUE(old) << old.error().message;
    EXPECT_EQ(old->settings, test_header(7).settings);
}

struct HeaderDamage {
    const char* error;
    std::function<void(v1::FrameHeader&)> apply;
};

TEST(Convert, HeaderOutOfRangeNamesTheField) {
    const std::vector<HeaderDamage> damages{
        {"camera.world_from_camera", [](auto& m) { m.clear_source(); }},
        {"not 12", [](auto& m) { m.mutable_source()->add_world_from_camera(0.0F); }},
        {"not finite", [](auto& m) { m.mutable_source()->set_world_from_camera(10, kNan); }},
        {"not finite", [](auto& m) { m.mutable_source()->set_world_from_camera(10, -kInf); }},
        {"not a rotation", [](auto& m) { m.mutable_source()->set_world_from_camera(0, 2.0F); }},
        {"not a rotation", [](auto& m) { m.mutable_source()->set_world_from_camera(4, -1.0F); }},
        {"focal_px", [](auto& m) { m.mutable_source()->set_focal_px(0.0F); }},
        {"focal_px", [](auto& m) { m.mutable_source()->set_focal_px(kNan); }},
        {"focal_px", [](auto& m) { m.mutable_source()->set_focal_px(kInf); }},
        {"principal_px", [](auto& m) { m.mutable_source()->set_principal_y_px(kNan); }},
        {"sides", [](auto& m) { m.mutable_source()->set_width_px(0); }},
        {"sides", [](auto& m) { m.mutable_source()->set_height_px(0xFFFFFFFF); }},
        {"guard_band", [](auto& m) { m.mutable_guard_band()->set_left_px(0xFFFFFFFF); }},
        {"with guard band", [](auto& m) { m.mutable_guard_band()->set_top_px(16384); }},
        {"unknown denoiser", [](auto& m) { m.clear_settings(); }},
        {"unknown denoiser", [](auto& m) { m.mutable_settings()->set_denoiser(static_cast<v1::Denoiser>(77)); }},
        {"unknown denoiser", [](auto& m) { m.mutable_settings()->set_denoiser(static_cast<v1::Denoiser>(5)); }},
        {"tone map", [](auto& m) { m.mutable_settings()->set_tone_map(v1::TONE_MAP_UNSPECIFIED); }},
        {"settings.sampler", [](auto& m) { m.mutable_settings()->set_sampler(static_cast<v1::Sampler>(3)); }},
        {"settings.sampler", [](auto& m) { m.mutable_settings()->set_sampler(static_cast<v1::Sampler>(-1)); }},
        {"or denoised images",
         [](auto& m) { m.mutable_settings()->set_denoised_images(static_cast<v1::DenoisedImages>(9)); }},
        {"samples_per_pixel", [](auto& m) { m.mutable_settings()->set_samples_per_pixel(0); }},
        {"samples_per_pixel", [](auto& m) { m.mutable_settings()->set_samples_per_pixel(65537); }},
        {"max_bounces", [](auto& m) { m.mutable_settings()->set_max_bounces(257); }},
        {"light_sampling.candidates",
         [](auto& m) { m.mutable_settings()->mutable_light_sampling()->set_candidates(65); }},
        {"indirect_clamp", [](auto& m) { m.mutable_settings()->set_indirect_clamp(kNan); }},
        {"temporal_alpha", [](auto& m) { m.mutable_settings()->set_temporal_alpha(1.5F); }},
        {"exposure", [](auto& m) { m.mutable_settings()->set_exposure(0.0F); }},
        {"exposure", [](auto& m) { m.mutable_settings()->set_exposure(kInf); }},
        {"min_normal_cos",
         [](auto& m) { m.mutable_settings()->mutable_reprojection()->set_min_normal_cos(-2.0F); }},
        {"cascade_rows", [](auto& m) { m.mutable_settings()->mutable_holes()->set_cascade_rows(73); }},
        {"layer_count", [](auto& m) { m.set_layer_count(1); }},
        {"applied_pose", [](auto& m) { m.mutable_applied_pose()->set_sequence(1); }},
        {"0 positions", [](auto& m) { m.mutable_sources()->clear_positions(); }},
        {"9 positions",
         [](auto& m) {
             while (m.sources().positions_size() < 9) {
                 m.mutable_sources()->add_positions()->set_col_halves(m.sources().positions_size());
             }
         }},
        {"twice", [](auto& m) { m.mutable_sources()->add_positions(); }},
        {"144 half steps", [](auto& m) { m.mutable_sources()->mutable_positions(0)->set_row_halves(-0x7FFFFFFF - 1); }},
        {"spacing", [](auto& m) { m.mutable_sources()->set_spacing_x_m(kNan); }},
        {"convergence", [](auto& m) { m.mutable_sources()->set_convergence_m(-1.0F); }},
        {"exceed 16384",
         [](auto& m) {
             for (int i = 1; i < 8; ++i) {
                 m.mutable_sources()->add_positions()->set_row_halves(2 * i);
             }
             m.mutable_source()->set_height_px(2100);
         }},
        {"render_times", [](auto& m) { m.mutable_render_times(0)->set_ms(std::nan("")); }},
        {"render_times", [](auto& m) { m.mutable_render_times(0)->set_stage(std::string(65, 'x')); }},
        {"render_times",
         [](auto& m) {
             while (m.render_times_size() <= 64) {
                 m.add_render_times();
             }
         }},
    };
    for (const HeaderDamage& damage : damages) {
        v1::FrameHeader message = valid_header();
        damage.apply(message);
        const auto header = from_proto(message, 7);
        ASSERT_FALSE(header) << damage.error;
        EXPECT_THAT(header.error().message, HasSubstr(damage.error));
    }
}

TEST(Convert, UnsetGridFieldsAreTheChannels) {
    const LatticeGeometry channel{{0.02F, 0.04F}, 2.5F};
    v1::Grid message;
    message.set_rows(2);
    message.set_cols(5);
    const auto grid = from_proto(message, channel);
    ASSERT_TRUE(grid) << grid.error().message;
    EXPECT_TRUE(*grid == (ViewGrid{2, 5, channel, Anchor::kLattice}));
}

TEST(Convert, ZeroAndInfiniteConvergenceMeanParallel) {
    for (const float asked_m : {0.0F, kInf}) {
        v1::Grid message;
        message.set_rows(1);
        message.set_cols(1);
        message.set_convergence_m(asked_m);
        const auto grid = from_proto(message, {{0.1F, 0.1F}, 3.0F});
        ASSERT_TRUE(grid);
        EXPECT_EQ(grid->geometry.convergence_m, kInf);
    }
}

TEST(Convert, ViewSetSurvives) {
    for (const Anchor anchor : {Anchor::kLattice, Anchor::kCentre}) {
        for (const float convergence_m : {kInf, 1.25F}) {
            const ViewSet set{{2, 3, {{0.01F, 0.0F}, convergence_m}, anchor}, 640, 360, 0.7F};
            v1::ViewSet message;
            to_proto(set, message);
            const auto back = from_proto(message);
            ASSERT_TRUE(back) << back.error().message;
            EXPECT_TRUE(*back == set);
        }
    }
}

struct ViewSetDamage {
    const char* error;
    std::function<void(v1::ViewSet&)> apply;
};

TEST(Convert, ViewSetOutOfRangeNamesTheField) {
    const std::vector<ViewSetDamage> damages{
        {"at most 72", [](auto& m) { m.mutable_grid()->set_rows(37); }},
        {"at most 72", [](auto& m) { m.mutable_grid()->set_cols(0x80000000U); }},
        {"start at 1", [](auto& m) { m.mutable_grid()->set_cols(0); }},
        {"must be set", [](auto& m) { m.mutable_grid()->clear_spacing_x_m(); }},
        {"must be set", [](auto& m) { m.clear_grid(); }},
        {"spacing", [](auto& m) { m.mutable_grid()->set_spacing_x_m(kNan); }},
        {"spacing", [](auto& m) { m.mutable_grid()->set_spacing_y_m(-1.0F); }},
        {"convergence", [](auto& m) { m.mutable_grid()->set_convergence_m(-1.0F); }},
        {"convergence", [](auto& m) { m.mutable_grid()->set_convergence_m(kNan); }},
        {"anchor", [](auto& m) { m.mutable_grid()->set_anchor(static_cast<v1::Anchor>(9)); }},
        {"sides", [](auto& m) { m.set_width_px(0); }},
        {"sides", [](auto& m) { m.set_height_px(16385); }},
        {"fovy_rad", [](auto& m) { m.set_fovy_rad(0.0F); }},
        {"fovy_rad", [](auto& m) { m.set_fovy_rad(3.2F); }},
        {"fovy_rad", [](auto& m) { m.set_fovy_rad(kNan); }},
    };
    for (const ViewSetDamage& damage : damages) {
        v1::ViewSet message;
        to_proto(ViewSet{{2, 2, {}, Anchor::kLattice}, 64, 36, 0.7F}, message);
        damage.apply(message);
        const auto set = from_proto(message);
        ASSERT_FALSE(set) << damage.error;
        EXPECT_THAT(set.error().message, HasSubstr(damage.error));
    }
}

TEST(Convert, UnknownEnumNumbersAreNothing) {
    for (const int number : {-1, 0, 8, 100, 257}) {
        EXPECT_FALSE(from_proto(static_cast<v1::PlaneSemantic>(number)));
        EXPECT_FALSE(from_proto(static_cast<v1::PlaneFormat>(number)));
        EXPECT_FALSE(from_proto(static_cast<v1::Codec>(number)));
    }
    for (const PlaneFormat format : kAllFormats) {
        EXPECT_EQ(from_proto(to_proto(format)), format);
        EXPECT_TRUE(may_have_format(semantic_of(format), format));
        EXPECT_FALSE(may_have_format(PlaneSemantic::kMaterial, format) && format != PlaneFormat::kRg8);
    }
}

} // namespace
} // namespace fieldcast::wire
