// SPDX-License-Identifier: Apache-2.0
// How the server fits a session to its connection: the ladder, and the session that climbs it.
#include "server/session/server_session.h"
#include "tests/server/synthetic.h"

#include <gmock/gmock.h>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;

v1::Configure adaptive(std::uint32_t side = 6) {
    v1::Configure wanted;
    wanted.set_request_id(7);
    wanted.mutable_grid()->set_rows(side);
    wanted.mutable_grid()->set_cols(side);
    v1::Adaptation& bounds = *wanted.mutable_adaptation();
    bounds.add_codecs(v1::CODEC_JPEG);
    bounds.set_min_quality(40);
    bounds.set_min_frames_per_second(25.0F);
    bounds.set_min_view_height_px(18);
    bounds.set_min_rows(3);
    bounds.set_min_cols(3);
    return wanted;
}

class AdaptationTest : public testing::Test {
protected:
    Ladder ladder(const v1::Configure& wanted) const {
        const std::vector<std::shared_ptr<feed::Feed>> channels{feed_};
        const auto granted = negotiate(wanted, channels, Limits{});
        EXPECT_TRUE(granted);
        return {wanted, *granted};
    }

    v1::ServerMessage next() {
        v1::ServerMessage message;
        if (const auto chunk = session_.next(now_)) {
            EXPECT_TRUE(message.ParseFromString(wire::joined(*chunk)));
        }
        return message;
    }

    void configure(const v1::Configure& wanted) {
        v1::ClientMessage message;
        *message.mutable_configure() = wanted;
        session_.on_message(message, now_);
        EXPECT_TRUE(next().has_configured());
    }

    /// One frame that is acknowledged after `on_the_way`; returns the Configured of a change, if one came.
    std::optional<v1::Configured> frame(milliseconds on_the_way) {
        std::optional<v1::Configured> changed;
        ++frame_id_;
        feed_->publish(test::synthetic_frame(feed_->info(), feed_->demand(now_), frame_id_, pool_, frame_id_), now_);
        for (v1::ServerMessage message = next(); message.message_case() != v1::ServerMessage::MESSAGE_NOT_SET;
             message = next()) {
            changed = message.has_configured() ? std::optional(message.configured()) : changed;
        }
        now_ += on_the_way;
        v1::ClientMessage message;
        message.mutable_frame_ack()->set_frame_id(frame_id_);
        message.mutable_frame_ack()->set_epoch(session_.epoch());
        message.mutable_frame_ack()->set_outcome(v1::FRAME_OUTCOME_DECODED);
        session_.on_message(message, now_);
        session_.on_tick(now_);
        return changed;
    }

    /// Frames until the server changes something.
    std::optional<v1::Configured> until_change(milliseconds on_the_way, int most_frames) {
        for (int i = 0; i < most_frames; ++i) {
            if (auto changed = frame(on_the_way)) {
                return changed;
            }
        }
        return std::nullopt;
    }

    std::shared_ptr<feed::Feed> feed_ = std::make_shared<feed::Feed>(test::synthetic_info());
    WorkerPool pool_{1};
    TimePoint now_{TimePoint::duration(1h)};
    std::uint64_t frame_id_ = 0;
    ServerSession session_{
        {feed_}, Limits{}, [this](const feed::FramePtr& frame) { session_.on_frame(frame, now_); }, now_};
};

TEST_F(AdaptationTest, TheLadderGoesFromTheLeastPainfulOn) {
    v1::Configure wanted = adaptive();
    wanted.mutable_adaptation()->add_modes(v1::DELIVERY_MODE_SCENE);
    std::string changes;
    double cost = 2.0;
    const Ladder made = ladder(wanted);
    for (const Rung& rung : made.rungs()) {
        changes += made.change(rung) + "; ";
        EXPECT_LT(rung.cost, cost) << made.change(rung);
        cost = rung.cost;
        const std::vector<std::shared_ptr<feed::Feed>> channels{feed_};
        EXPECT_TRUE(negotiate(made.configure(rung), channels, Limits{})) << "every rung is a Configure that is granted";
    }
    EXPECT_EQ(changes, "as asked for; jpeg of quality 75; quality 55; quality 40; 1/2 of the frames; "
                       "1/4 of the frames; views of 43x24; views of 32x18; 5x5 views; 4x4 views; 3x3 views; ")
        << "two planes of 64x36 are more than nine views of 32x18, so that mode scene would not help";
}

TEST_F(AdaptationTest, BoundsHold) {
    v1::Configure wanted = adaptive();
    wanted.mutable_adaptation()->Clear();
    EXPECT_EQ(ladder(wanted).rungs().size(), 1U) << "nothing may change";
    wanted.mutable_adaptation()->set_min_quality(40);
    EXPECT_EQ(ladder(wanted).rungs().size(), 1U) << "lossless stays lossless unless JPEG is allowed";
    wanted.mutable_adaptation()->add_modes(v1::DELIVERY_MODE_SCENE);
    const Ladder made = ladder(wanted);
    ASSERT_EQ(made.rungs().size(), 2U) << "36 views are more than two planes";
    EXPECT_EQ(made.configure(made.rungs()[1]).modes(0), v1::DELIVERY_MODE_SCENE);
    EXPECT_EQ(made.configure(made.rungs()[1]).planes(), v1::PLANE_SET_ILLUMINATION);
}

TEST_F(AdaptationTest, EveryModeHasPlanesThatCanBecomeJpeg) {
    struct Mode {
        v1::DeliveryMode mode;
        std::vector<PlaneSemantic> pictures;
    };
    for (const Mode& mode : {Mode{v1::DELIVERY_MODE_VIEWS, {PlaneSemantic::kColour}},
                             Mode{v1::DELIVERY_MODE_SCENE, {PlaneSemantic::kDiffuse, PlaneSemantic::kSpecular}},
                             Mode{v1::DELIVERY_MODE_WARP, {PlaneSemantic::kColour, PlaneSemantic::kResidualColour}}}) {
        v1::Configure wanted = adaptive();
        wanted.add_modes(mode.mode);
        wanted.add_warp_planes(v1::WARP_PLANE_RESIDUAL);
        const Ladder made = ladder(wanted);
        ASSERT_GT(made.rungs().size(), 2U);
        for (const Rung& rung : made.rungs().subspan(1, 2)) {
            const std::vector<std::shared_ptr<feed::Feed>> channels{feed_};
            const v1::Configured got = to_message(*negotiate(made.configure(rung), channels, Limits{}), 1, 2, 2);
            std::vector<PlaneSemantic> lossy;
            for (const v1::PlaneHeader& plane : got.planes()) {
                if (plane.codec() == v1::CODEC_JPEG) {
                    EXPECT_EQ(plane.quality(), rung.quality);
                    lossy.push_back(*wire::from_proto(plane.semantic()));
                }
            }
            EXPECT_EQ(lossy, mode.pictures) << v1::DeliveryMode_Name(mode.mode);
        }
    }
}

TEST_F(AdaptationTest, TheLadderKeepsALossyCodecAndRaisesNoQuality) {
    v1::Configure wanted = adaptive();
    v1::CodecPreference& colour = *wanted.add_codecs();
    colour.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
    colour.add_codecs(v1::CODEC_H264);
    colour.set_quality(55);
    const Ladder made = ladder(wanted);
    EXPECT_EQ(made.change(made.rungs()[1]), "quality 40");
    const v1::Configure next = made.configure(made.rungs()[1]);
    EXPECT_EQ(next.codecs(0).codecs(0), v1::CODEC_H264);
    EXPECT_EQ(next.codecs(0).quality(), 40U);
}

TEST_F(AdaptationTest, AWarpSessionOnANarrowConnectionGetsFewerBytes) {
    v1::Configure wanted = adaptive();
    wanted.add_modes(v1::DELIVERY_MODE_WARP);
    configure(wanted);
    frame(20ms);
    const std::uint64_t before = session_.counts().plane_bytes.begin()->second;
    until_change(20ms, 60);
    const auto down = until_change(400ms, 12);
    ASSERT_TRUE(down);
    EXPECT_EQ(down->planes(0).semantic(), v1::PLANE_SEMANTIC_COLOUR);
    EXPECT_EQ(down->planes(0).codec(), v1::CODEC_JPEG);
    frame(20ms);
    frame(20ms);
    std::uint64_t jpeg_bytes = 0;
    for (const auto& [choice, bytes] : session_.counts().plane_bytes) {
        jpeg_bytes += choice.encoding.codec == Codec::kJpeg ? bytes : 0;
    }
    EXPECT_GT(before, 0U);
    EXPECT_GT(jpeg_bytes, 0U) << "colour really comes as JPEG";
}

TEST_F(AdaptationTest, AQueueTakesTheSessionDownAndCalmBringsItBack) {
    configure(adaptive());
    EXPECT_FALSE(until_change(20ms, 60)) << "a good connection";
    const auto down = until_change(400ms, 12);
    ASSERT_TRUE(down);
    EXPECT_EQ(down->request_id(), 7U);
    EXPECT_EQ(down->epoch(), 2U);
    EXPECT_EQ(down->adapted().reason(), v1::ADAPTATION_REASON_QUEUE_DELAY);
    EXPECT_GE(down->adapted().level(), 1U);
    EXPECT_GE(down->adapted().queue_delay_ms(), 300U);
    EXPECT_GT(down->adapted().delivered_bytes_per_second(), 0U);
    EXPECT_EQ(down->planes(0).codec(), v1::CODEC_JPEG);
    EXPECT_EQ(session_.adapted_level(), down->adapted().level());
    EXPECT_EQ(session_.counts().adaptations.down, 1U);
    const auto up = until_change(20ms, 400); // five seconds of calm, eight of patience
    ASSERT_TRUE(up);
    EXPECT_EQ(up->adapted().reason(), v1::ADAPTATION_REASON_RECOVERED);
    EXPECT_EQ(up->adapted().level(), down->adapted().level() - 1);
    EXPECT_EQ(up->epoch(), 3U);
    EXPECT_EQ(session_.counts().adaptations.up, 1U);
}

TEST_F(AdaptationTest, WhoDoesNotAllowItKeepsWhatWasGranted) {
    v1::Configure wanted = adaptive();
    wanted.clear_adaptation();
    configure(wanted);
    until_change(20ms, 30);
    EXPECT_FALSE(until_change(500ms, 30));
    EXPECT_EQ(session_.epoch(), 1U);
}

TEST_F(AdaptationTest, AnotherRequestStartsAtItsOwnTop) {
    configure(adaptive());
    until_change(20ms, 30);
    ASSERT_TRUE(until_change(400ms, 12));
    v1::Configure wanted = adaptive(4);
    wanted.set_request_id(8);
    v1::ClientMessage message;
    *message.mutable_configure() = wanted;
    session_.on_message(message, now_);
    EXPECT_EQ(session_.adapted_level(), 0U);
    v1::ServerMessage answer = next();
    while (!answer.has_configured()) {
        answer = next();
    }
    EXPECT_EQ(answer.configured().request_id(), 8U);
    EXPECT_FALSE(answer.configured().has_adapted());
    EXPECT_EQ(answer.configured().planes(0).codec(), v1::CODEC_ZSTD_FILTERED);
}

} // namespace
} // namespace fieldcast::session
