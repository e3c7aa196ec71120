// SPDX-License-Identifier: Apache-2.0
#include "server/session/negotiate.h"
#include "server/session/quality_rungs.h"
#include "tests/server/synthetic.h"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>
#include <map>

namespace fieldcast::session {
namespace {

class Negotiate : public testing::Test {
protected:
    tl::expected<Configuration, Refusal> ask() { return negotiate(wanted_, channels_, limits_); }

    /// The refusal of what is asked; an acceptance is a failure with an empty refusal.
    Refusal refusal() {
        const auto answer = ask();
        EXPECT_FALSE(answer.has_value());
        return answer ? Refusal{} : answer.error();
    }

    void set_grid(std::uint32_t rows, std::uint32_t cols) {
        wanted_.mutable_grid()->set_rows(rows);
        wanted_.mutable_grid()->set_cols(cols);
    }

    std::vector<std::shared_ptr<feed::Feed>> channels_{std::make_shared<feed::Feed>(test::synthetic_info("first")),
                                                       std::make_shared<feed::Feed>(test::synthetic_info("second"))};
    Limits limits_;
    v1::Configure wanted_;
};

TEST_F(Negotiate, FillsEverythingLeftOpen) {
    const auto answer = ask();
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->feed->info().name, "first");
    EXPECT_EQ(answer->mode, DeliveryMode::kViews);
    EXPECT_EQ(answer->view_set.grid, channels_[0]->info().largest_grid);
    EXPECT_EQ(answer->view_set.width_px, 64U);
    EXPECT_EQ(answer->view_set.height_px, 36U);
    EXPECT_EQ(answer->frames_per_second, 100.0F);
    EXPECT_EQ(answer->chunk_bytes, wire::kDefaultChunkBytes);
    EXPECT_EQ(answer->max_bytes_in_flight, limits_.max_bytes_in_flight);
}

TEST_F(Negotiate, TakesTheFirstModeItHas) {
    wanted_.add_modes(static_cast<v1::DeliveryMode>(99));
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    wanted_.add_modes(v1::DELIVERY_MODE_VIEWS);
    const auto answer = ask();
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->mode, DeliveryMode::kScene);
}

std::vector<PlaneSemantic> planes_of(const Configuration& configuration) {
    std::vector<PlaneSemantic> planes;
    for (const wire::PlaneChoice& choice : std::get<feed::PlaneSelection>(configuration.selection).choices) {
        planes.push_back(choice.semantic);
    }
    return planes;
}

TEST_F(Negotiate, WarpHasColourAndDepthAndWhatElseIsAsked) {
    using enum PlaneSemantic;
    wanted_.add_modes(v1::DELIVERY_MODE_WARP);
    auto answer = ask();
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->mode, DeliveryMode::kWarp);
    EXPECT_EQ(planes_of(*answer), (std::vector{kColour, kInverseDepth}));
    wanted_.add_warp_planes(v1::WARP_PLANE_ID);
    wanted_.add_warp_planes(static_cast<v1::WarpPlane>(99));
    wanted_.add_warp_planes(v1::WARP_PLANE_RESIDUAL);
    wanted_.add_warp_planes(v1::WARP_PLANE_NORMAL);
    answer = ask();
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(planes_of(*answer),
              (std::vector{kColour, kInverseDepth, kResidualColour, kResidualInverseDepth, kNormal, kId}));
    const v1::Configured message = to_message(*answer, 1, 1, 2);
    EXPECT_EQ(message.planes(1).format(), v1::PLANE_FORMAT_R16);
    EXPECT_EQ(message.planes(1).width_px(), 64U + 2 + 3);
    EXPECT_EQ(message.planes(2).width_px(), 1024U);
    EXPECT_EQ(message.planes(2).height_px(), 16U); // 4 views of 8 × 5 tiles are 160
}

TEST_F(Negotiate, RefusesWarpFromSeveralSources) {
    feed::ChannelInfo info = test::synthetic_info("first");
    info.source_count = 2;
    channels_ = {std::make_shared<feed::Feed>(info)};
    wanted_.add_modes(v1::DELIVERY_MODE_WARP);
    const Refusal answer = refusal();
    EXPECT_EQ(answer.reason, v1::REFUSAL_REASON_UNSUPPORTED);
    EXPECT_EQ(answer.field, "modes");
    EXPECT_NE(answer.message.find("warp needs one source, it has 2"), std::string::npos);
    wanted_.add_modes(v1::DELIVERY_MODE_VIEWS);
    EXPECT_TRUE(ask().has_value());
}

TEST_F(Negotiate, RefusesUnknownChannelNamingTheOthers) {
    wanted_.set_channel("third");
    const Refusal answer = refusal();
    EXPECT_EQ(answer.reason, v1::REFUSAL_REASON_NOT_FOUND);
    EXPECT_EQ(answer.field, "channel");
    EXPECT_NE(answer.message.find("first, second"), std::string::npos);
}

TEST_F(Negotiate, TakesAnyGridUpTo72Views) {
    for (const auto& [rows, cols] : {std::pair(3U, 3U), std::pair(6U, 6U), std::pair(1U, 72U), std::pair(8U, 9U)}) {
        set_grid(rows, cols);
        const auto answer = ask();
        ASSERT_TRUE(answer.has_value()) << rows << "x" << cols;
        EXPECT_EQ(answer->view_set.grid.view_count(), rows * cols);
        EXPECT_EQ(answer->view_set.grid.geometry, channels_[0]->info().largest_grid.geometry);
    }
}

TEST_F(Negotiate, RefusesGridsByField) {
    set_grid(0, 3);
    EXPECT_EQ(refusal().field, "grid.rows");
    set_grid(3, 73);
    EXPECT_EQ(refusal().field, "grid.cols");
    set_grid(9, 9);
    EXPECT_EQ(refusal().field, "grid");
    EXPECT_NE(refusal().message.find("72"), std::string::npos);
    set_grid(3, 3);
    wanted_.mutable_grid()->set_spacing_x_m(-1.0F);
    EXPECT_EQ(refusal().field, "grid.spacing_x_m");
    wanted_.mutable_grid()->set_spacing_x_m(0.1F);
    wanted_.mutable_grid()->set_spacing_y_m(std::numeric_limits<float>::infinity());
    EXPECT_EQ(refusal().field, "grid.spacing_y_m");
    wanted_.mutable_grid()->set_spacing_y_m(0.1F);
    wanted_.mutable_grid()->set_convergence_m(std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(refusal().field, "grid.convergence_m");
}

TEST_F(Negotiate, RefusesViewsLargerThanTheSource) {
    wanted_.set_view_width_px(65);
    wanted_.set_view_height_px(36);
    EXPECT_EQ(refusal().field, "view_width_px");
    wanted_.set_view_width_px(64);
    wanted_.set_view_height_px(37);
    EXPECT_EQ(refusal().field, "view_height_px");
    EXPECT_NE(refusal().message.find("36"), std::string::npos);
    wanted_.set_view_height_px(0);
    EXPECT_EQ(refusal().field, "view_height_px");
}

TEST_F(Negotiate, RefusesFieldsOfViewBeyondTheSource) {
    for (const float fovy_rad : {1.0F, -0.1F, std::numeric_limits<float>::quiet_NaN()}) {
        wanted_.set_fovy_rad(fovy_rad);
        EXPECT_EQ(refusal().field, "fovy_rad");
    }
    wanted_.set_fovy_rad(0.5F);
    EXPECT_EQ(ask()->view_set.fovy_rad, 0.5F);
}

TEST_F(Negotiate, RefusesMorePixelsThanTheBudget) {
    limits_.max_view_set_pixels = 9ULL * 64 * 36;
    set_grid(3, 3);
    EXPECT_TRUE(ask().has_value());
    set_grid(3, 4);
    EXPECT_EQ(refusal().field, "grid");
    EXPECT_NE(refusal().message.find(std::to_string(limits_.max_view_set_pixels)), std::string::npos);
}

TEST_F(Negotiate, ChoosesPlanesAndCodecs) {
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    wanted_.set_planes(v1::PLANE_SET_WITH_G_BUFFER);
    v1::CodecPreference& depth = *wanted_.add_codecs();
    depth.set_semantic(v1::PLANE_SEMANTIC_DEPTH);
    depth.add_codecs(static_cast<v1::Codec>(99));
    depth.add_codecs(v1::CODEC_RAW);
    const auto answer = ask();
    ASSERT_TRUE(answer.has_value());
    const auto& planes = std::get<feed::PlaneSelection>(answer->selection).choices;
    ASSERT_EQ(planes.size(), 6U);
    EXPECT_EQ(planes[0].encoding.codec, Codec::kZstdFiltered);
    EXPECT_EQ(planes[2].semantic, PlaneSemantic::kDepth);
    EXPECT_EQ(planes[2].encoding.codec, Codec::kRaw);
}

TEST_F(Negotiate, GivesH264ToViewsAndNotToLight) {
    for (const auto semantic : {v1::PLANE_SEMANTIC_COLOUR, v1::PLANE_SEMANTIC_DIFFUSE}) {
        v1::CodecPreference& preference = *wanted_.add_codecs();
        preference.set_semantic(semantic);
        preference.add_codecs(v1::CODEC_H264);
        preference.add_codecs(v1::CODEC_JPEG);
    }
    EXPECT_EQ(std::get<feed::ViewSelection>(ask()->selection).format.encoding, (codec::Encoding{Codec::kH264, 75}));
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    EXPECT_EQ(std::get<feed::PlaneSelection>(ask()->selection).choices[0].encoding,
              (codec::Encoding{Codec::kJpeg, 75}));
    wanted_.clear_codecs();
    wanted_.clear_modes();
    EXPECT_EQ(std::get<feed::ViewSelection>(ask()->selection).format.encoding, codec::Encoding{}) << "only who asks gets it";
}

TEST_F(Negotiate, ChoosesTheFirstCodecThatFitsThePlane) {
    const auto prefer = [this](v1::PlaneSemantic semantic, std::uint32_t quality) {
        v1::CodecPreference& preference = *wanted_.add_codecs();
        preference.set_semantic(semantic);
        preference.set_quality(quality);
        preference.add_codecs(v1::CODEC_JPEG);
        preference.add_codecs(v1::CODEC_RAW);
    };
    prefer(v1::PLANE_SEMANTIC_COLOUR, 0);
    const auto format = [](const Configuration& chosen) { return std::get<feed::ViewSelection>(chosen.selection).format; };
    EXPECT_EQ(format(*ask()).encoding, (codec::Encoding{Codec::kJpeg, 75}));
    wanted_.mutable_codecs(0)->set_quality(40);
    EXPECT_EQ(format(*ask()).encoding, (codec::Encoding{Codec::kJpeg, 40}));
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    wanted_.set_planes(v1::PLANE_SET_WITH_G_BUFFER);
    prefer(v1::PLANE_SEMANTIC_DEPTH, 55);
    prefer(v1::PLANE_SEMANTIC_DIFFUSE, 55);
    EXPECT_EQ(std::get<feed::PlaneSelection>(ask()->selection).choices[0].encoding,
              (codec::Encoding{Codec::kJpeg, 55}));
    EXPECT_EQ(std::get<feed::PlaneSelection>(ask()->selection).choices[1].encoding, codec::Encoding{});
    EXPECT_EQ(std::get<feed::PlaneSelection>(ask()->selection).choices[2].encoding, (codec::Encoding{Codec::kRaw, 0}));
    prefer(v1::PLANE_SEMANTIC_NORMAL, 101);
    EXPECT_EQ(refusal().field, "codecs");
    EXPECT_EQ(refusal().reason, v1::REFUSAL_REASON_INVALID);
}

TEST_F(Negotiate, SceneMayHaveOnePlaneOfLight) {
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    wanted_.set_planes(v1::PLANE_SET_TOTAL_LIGHT);
    v1::CodecPreference& light = *wanted_.add_codecs();
    light.set_semantic(v1::PLANE_SEMANTIC_TOTAL_LIGHT);
    light.add_codecs(v1::CODEC_JPEG);
    light.set_quality(55);
    const auto answer = ask();
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(planes_of(*answer), std::vector{PlaneSemantic::kTotalLight});
    EXPECT_EQ(feed::to_text(answer->selection), "planes total_light jpeg 55");
    const v1::Configured message = to_message(*answer, 1, 1, 2);
    EXPECT_EQ(message.planes(0).format(), v1::PLANE_FORMAT_R11G11B10F);
    EXPECT_EQ(message.planes(0).width_px(), 64U + 2 + 3);
}

TEST_F(Negotiate, TakesTheFirstFormatThatThePlaneCanHave) {
    wanted_.add_modes(v1::DELIVERY_MODE_WARP);
    wanted_.add_warp_planes(v1::WARP_PLANE_NORMAL);
    EXPECT_EQ(to_message(*ask(), 1, 1, 2).planes(2).format(), v1::PLANE_FORMAT_OCT2X16) << "unless asked";
    v1::CodecPreference& normal = *wanted_.add_codecs();
    normal.set_semantic(v1::PLANE_SEMANTIC_NORMAL);
    normal.add_formats(static_cast<v1::PlaneFormat>(99));
    normal.add_formats(v1::PLANE_FORMAT_R16);
    normal.add_formats(v1::PLANE_FORMAT_OCT2X8);
    normal.add_formats(v1::PLANE_FORMAT_OCT2X16);
    const auto answer = ask();
    ASSERT_TRUE(answer.has_value());
    const wire::PlaneChoice choice = std::get<feed::PlaneSelection>(answer->selection).choices[2];
    EXPECT_EQ(choice.format, PlaneFormat::kOct2x8);
    EXPECT_EQ(choice.encoding, codec::Encoding{}) << "codecs are another question";
    EXPECT_EQ(to_message(*answer, 1, 1, 2).planes(2).format(), v1::PLANE_FORMAT_OCT2X8);
    EXPECT_EQ(feed::to_text(answer->selection), "planes colour zstd, inverse_depth zstd, normal oct2x8 zstd");
    normal.clear_formats();
    normal.add_formats(v1::PLANE_FORMAT_OCT2X16);
    EXPECT_EQ(std::get<feed::PlaneSelection>(ask()->selection).choices[2].format, std::nullopt) << "one name for one thing";
}

TEST_F(Negotiate, RefusesFormatsThatThePlaneNeverHas) {
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    wanted_.set_planes(v1::PLANE_SET_WITH_G_BUFFER);
    v1::CodecPreference& depth = *wanted_.add_codecs();
    depth.set_semantic(v1::PLANE_SEMANTIC_DEPTH);
    depth.add_formats(v1::PLANE_FORMAT_OCT2X8);
    const Refusal answer = refusal();
    EXPECT_EQ(answer.field, "codecs");
    EXPECT_EQ(answer.reason, v1::REFUSAL_REASON_UNSUPPORTED);
    EXPECT_NE(answer.message.find("; f32 is"), std::string::npos) << answer.message;
}

TEST_F(Negotiate, RefusesUnknownCodecsAlone) {
    v1::CodecPreference& colour = *wanted_.add_codecs();
    colour.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
    colour.add_codecs(static_cast<v1::Codec>(99));
    EXPECT_EQ(refusal().field, "codecs");
    EXPECT_EQ(refusal().reason, v1::REFUSAL_REASON_UNSUPPORTED);
}

TEST_F(Negotiate, QualitiesAreFewAndAnnounced) {
    v1::CodecPreference& colour = *wanted_.add_codecs();
    colour.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
    colour.add_codecs(v1::CODEC_JPEG);
    std::map<std::uint32_t, std::uint32_t> first_asked; // by what was chosen
    for (std::uint32_t asked = 1; asked <= kMaxQuality; ++asked) {
        colour.set_quality(asked);
        const std::uint32_t chosen = to_message(*ask(), 1, 1, 2).planes(0).quality();
        EXPECT_LE(chosen, std::max(asked, 10U)) << "nobody gets more than he asked for";
        first_asked.try_emplace(chosen, asked);
    }
    EXPECT_EQ(first_asked, (std::map<std::uint32_t, std::uint32_t>{
                               {10, 1}, {25, 25}, {40, 40}, {55, 55}, {75, 75}, {90, 90}}));
    colour.set_codecs(0, v1::CODEC_ZSTD_FILTERED);
    EXPECT_EQ(to_message(*ask(), 1, 1, 2).planes(0).quality(), 0U);
}

TEST_F(Negotiate, TheQualityOfTheChannelIsOneMore) {
    EXPECT_EQ(quality_rung(0, 80), 80);
    EXPECT_EQ(quality_rung(79, 80), 75);
    EXPECT_EQ(quality_rung(80, 80), 80);
    EXPECT_EQ(quality_rung(89, 80), 80);
    EXPECT_EQ(quality_rung(100, 80), 90);
    EXPECT_EQ(quality_rung(3, 80), 10) << "the lowest one stands for all below";
}

TEST_F(Negotiate, SlowerThanTheSlowestRateIsRefusedByField) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float rate : {0.004F, 1e-30F, 0.0999F, -1.0F, std::nanf(""), kInfinity, -kInfinity}) {
        wanted_.set_max_frames_per_second(rate);
        EXPECT_EQ(refusal().field, "max_frames_per_second") << rate;
        EXPECT_THAT(refusal().message, testing::HasSubstr("from 0.1 on"));
        wanted_.set_max_frames_per_second(0.1F);
        EXPECT_EQ(ask()->frames_per_second, 0.1F);
        wanted_.mutable_adaptation()->set_min_frames_per_second(rate);
        EXPECT_EQ(refusal().field, "adaptation.min_frames_per_second") << rate;
        wanted_.clear_adaptation();
    }
}

TEST_F(Negotiate, RefusesRatesAndChunkSizesByField) {
    wanted_.set_max_frames_per_second(-1.0F);
    EXPECT_EQ(refusal().field, "max_frames_per_second");
    wanted_.set_max_frames_per_second(1e9F);
    EXPECT_EQ(ask()->frames_per_second, 100.0F);
    wanted_.set_chunk_bytes(1);
    EXPECT_EQ(refusal().field, "chunk_bytes");
    wanted_.set_chunk_bytes(wire::kMaxChunkBytes + 1);
    EXPECT_EQ(refusal().field, "chunk_bytes");
}

std::vector<std::uint32_t> announced_heights(const Configuration& configuration) {
    std::vector<std::uint32_t> heights;
    const v1::Configured message = to_message(configuration, 1, 1, 2);
    for (const v1::PlaneHeader& plane : message.planes()) {
        heights.push_back(plane.height_px());
    }
    return heights;
}

TEST_F(Negotiate, AnnouncesPlanesWithSourcesAndLayers) {
    feed::ChannelInfo info = test::synthetic_info("first");
    info.guard_band = {.left_px = 3, .right_px = 4, .top_px = 5, .bottom_px = 6};
    channels_[0] = std::make_shared<feed::Feed>(info);
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    wanted_.set_planes(v1::PLANE_SET_WITH_G_BUFFER);
    EXPECT_EQ(announced_heights(*ask()), (std::vector{141U, 141U, 47U, 47U, 47U, 47U}));
    EXPECT_EQ(to_message(*ask(), 1, 1, 2).planes(0).width_px(), 71U);
    wanted_.set_planes(v1::PLANE_SET_TOTAL_LIGHT);
    EXPECT_EQ(announced_heights(*ask()), std::vector{141U});
    info.source_count = 2;
    channels_[0] = std::make_shared<feed::Feed>(info);
    EXPECT_EQ(announced_heights(*ask()), std::vector{282U});
    info.source_height_px = 16000; // its planes cannot have layers, or nobody could take them
    channels_[0] = std::make_shared<feed::Feed>(info);
    EXPECT_EQ(announced_heights(*ask()), std::vector{kMaxPlaneSide});
}

} // namespace
} // namespace fieldcast::session
