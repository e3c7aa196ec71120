// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recorded_form.h"
#include "server/session/negotiate.h"
#include "tests/server/synthetic.h"

#include <gmock/gmock.h>

namespace fieldcast::session {
namespace {

using testing::HasSubstr;

/// A channel that shows a recording of 3x3 small views in two codecs, and of the illumination.
class Recorded : public testing::Test {
protected:
    Recorded() {
        feed::ChannelInfo info = test::synthetic_info("hall");
        for (const char* const form : {"views:3x3:32x18", "views:3x3:32x18:jpeg:40", "illumination"}) {
            info.recorded.push_back(recording::selection_of(*recording::parse_form(form), info));
        }
        channels_.push_back(std::make_shared<feed::Feed>(info));
    }

    tl::expected<Configuration, Refusal> ask() { return negotiate(wanted_, channels_, {}); }

    Refusal refusal() {
        const auto answer = ask();
        EXPECT_FALSE(answer.has_value());
        return answer ? Refusal{} : answer.error();
    }

    void set_grid(std::uint32_t rows, std::uint32_t cols) {
        wanted_.mutable_grid()->set_rows(rows);
        wanted_.mutable_grid()->set_cols(cols);
    }

    void want_codecs(v1::PlaneSemantic semantic, std::initializer_list<v1::Codec> codecs, std::uint32_t quality = 0) {
        v1::CodecPreference& preference = *wanted_.add_codecs();
        preference.set_semantic(semantic);
        preference.set_quality(quality);
        for (const v1::Codec codec : codecs) {
            preference.add_codecs(codec);
        }
    }

    codec::Encoding encoding() {
        const auto answer = ask();
        EXPECT_TRUE(answer.has_value());
        return answer ? std::get<feed::ViewSelection>(answer->selection).format.encoding : codec::Encoding{};
    }

    std::vector<std::shared_ptr<feed::Feed>> channels_;
    v1::Configure wanted_;
};

TEST_F(Recorded, WhatIsLeftOpenIsWhatWasRecorded) {
    const auto answer = ask();
    ASSERT_TRUE(answer.has_value()) << answer.error().message;
    EXPECT_EQ(answer->view_set.grid.view_count(), 9U);
    EXPECT_EQ(answer->view_set.width_px, 32U);
    EXPECT_EQ(encoding(), codec::Encoding{}) << "lossy only for who asks for it";
}

TEST_F(Recorded, PartsOfAGridCanBeHad) {
    set_grid(2, 3);
    const auto answer = ask();
    ASSERT_TRUE(answer.has_value()) << answer.error().message;
    EXPECT_EQ(answer->view_set.grid.view_count(), 6U);
    EXPECT_EQ(answer->view_set.height_px, 18U);
}

TEST_F(Recorded, RefusalsNameWhatWasRecorded) {
    set_grid(4, 4);
    EXPECT_EQ(refusal().reason, v1::REFUSAL_REASON_UNSUPPORTED);
    EXPECT_EQ(refusal().field, "grid");
    EXPECT_THAT(refusal().message, HasSubstr("recorded: views 3x3 of 32x18 zstd; views 3x3 of 32x18 jpeg 40; planes"));
    set_grid(3, 3);
    wanted_.set_view_width_px(64);
    wanted_.set_view_height_px(36);
    EXPECT_THAT(refusal().message, HasSubstr("without views 3x3 of 64x36 zstd"));
}

TEST_F(Recorded, OtherSpacingsAreOtherViews) {
    set_grid(3, 3);
    wanted_.mutable_grid()->set_spacing_x_m(0.5F);
    EXPECT_EQ(refusal().reason, v1::REFUSAL_REASON_UNSUPPORTED);
}

TEST_F(Recorded, CodecsThatWereNotRecordedArePassedOver) {
    want_codecs(v1::PLANE_SEMANTIC_COLOUR, {v1::CODEC_RAW, v1::CODEC_JPEG, v1::CODEC_ZSTD_FILTERED});
    EXPECT_EQ(encoding(), (codec::Encoding{.codec = Codec::kJpeg, .quality = 40}))
        << "wanted before ZSTD_FILTERED";
    wanted_.clear_codecs();
    want_codecs(v1::PLANE_SEMANTIC_COLOUR, {v1::CODEC_JPEG});
    EXPECT_EQ(encoding(), (codec::Encoding{.codec = Codec::kJpeg, .quality = 40}));
    wanted_.clear_codecs();
    want_codecs(v1::PLANE_SEMANTIC_COLOUR, {v1::CODEC_JPEG}, 41);
    EXPECT_EQ(refusal().reason, v1::REFUSAL_REASON_UNSUPPORTED);
}

TEST_F(Recorded, PlanesCanBeHadWithoutWhatWasNotRecorded) {
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    EXPECT_TRUE(ask().has_value());
    wanted_.set_planes(v1::PLANE_SET_WITH_G_BUFFER);
    EXPECT_EQ(refusal().field, "planes");
}

TEST_F(Recorded, FormatsThatWereNotRecordedArePassedOver) {
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    v1::CodecPreference& diffuse = *wanted_.add_codecs();
    diffuse.set_semantic(v1::PLANE_SEMANTIC_DIFFUSE);
    diffuse.add_formats(v1::PLANE_FORMAT_OCT2X8);
    diffuse.add_formats(v1::PLANE_FORMAT_R11G11B10F);
    EXPECT_TRUE(ask().has_value());
    diffuse.mutable_formats()->RemoveLast();
    EXPECT_EQ(refusal().reason, v1::REFUSAL_REASON_UNSUPPORTED);
}

TEST_F(Recorded, ModesAreTriedInTheirOrder) {
    set_grid(4, 4); // not as views, but clients make their own from planes
    wanted_.add_modes(v1::DELIVERY_MODE_VIEWS);
    wanted_.add_modes(v1::DELIVERY_MODE_SCENE);
    const auto answer = ask();
    ASSERT_TRUE(answer.has_value()) << answer.error().message;
    EXPECT_EQ(answer->mode, DeliveryMode::kScene);
}

} // namespace
} // namespace fieldcast::session
