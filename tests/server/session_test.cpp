// SPDX-License-Identifier: Apache-2.0
#include "server/session/server_session.h"
#include "tests/server/synthetic.h"

#include <gtest/gtest.h>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;

class SessionTest : public testing::Test {
protected:
    void configure(const v1::Configure& wanted = {}) {
        v1::ClientMessage message;
        *message.mutable_configure() = wanted;
        session_.on_message(message, now_);
    }

    /// `key_frame_id`: that strips refer to; the frame's own if nothing is said.
    void publish(std::optional<std::uint64_t> key_frame_id = std::nullopt) {
        ++frame_id_;
        feed_->publish(test::synthetic_frame(feed_->info(), feed_->demand(now_), frame_id_, pool_,
                                             key_frame_id.value_or(frame_id_)),
                       now_);
    }

    void configure_with_key_frames() {
        v1::Configure wanted;
        wanted.set_keeps_key_frames(true);
        configure(wanted);
        drain();
    }

    /// Header::key_frame_id of the next frame to be written; its other chunks are written too.
    std::uint64_t next_key_frame_id() {
        const v1::ServerMessage message = next();
        EXPECT_TRUE(message.frame_chunk().has_header());
        EXPECT_EQ(drain(), 1);
        return message.frame_chunk().header().key_frame_id();
    }

    /// The next message, or one of no kind.
    v1::ServerMessage next() {
        v1::ServerMessage message;
        if (const auto chunk = session_.next(now_)) {
            EXPECT_TRUE(message.ParseFromString(wire::joined(*chunk)));
        }
        return message;
    }

    /// Writes until nothing is left; the number of complete frames.
    int drain() {
        int trailers = 0;
        for (v1::ServerMessage message = next(); message.message_case() != v1::ServerMessage::MESSAGE_NOT_SET;
             message = next()) {
            trailers += message.frame_chunk().has_trailer() ? 1 : 0;
        }
        return trailers;
    }

    void acknowledge(std::uint64_t frame_id) {
        v1::ClientMessage message;
        message.mutable_frame_ack()->set_frame_id(frame_id);
        message.mutable_frame_ack()->set_epoch(session_.epoch());
        session_.on_message(message, now_);
    }

    std::uint64_t dropped(DropReason reason) const { return session_.counts().drops.of(reason); }

    TimePoint now_{1h};
    std::uint64_t frame_id_ = 0;
    WorkerPool pool_{1};
    std::shared_ptr<feed::Feed> feed_ = std::make_shared<feed::Feed>(test::synthetic_info());
    ServerSession session_{
        {feed_}, Limits{}, [this](const feed::FramePtr& frame) { session_.on_frame(frame, now_); }, now_};
};

TEST_F(SessionTest, AnswersConfigureBeforeFrames) {
    configure();
    publish();
    EXPECT_EQ(next().configured().epoch(), 1U);
    EXPECT_TRUE(next().frame_chunk().has_header());
}

TEST_F(SessionTest, RefusalKeepsTheOldConfiguration) {
    configure();
    v1::Configure wanted;
    wanted.set_request_id(5);
    wanted.add_modes(static_cast<v1::DeliveryMode>(99));
    configure(wanted);
    EXPECT_EQ(next().configured().epoch(), 1U);
    EXPECT_EQ(next().refused().request_id(), 5U);
    publish();
    EXPECT_EQ(drain(), 1);
}

TEST_F(SessionTest, SendsNoMoreThanItsCredits) {
    configure();
    for (int i = 0; i < 20; ++i) {
        now_ += 10ms;
        publish();
        drain();
    }
    EXPECT_EQ(session_.counts().frames_sent, kMinCredits);
    EXPECT_EQ(dropped(DropReason::kNoCredit), 20 - kMinCredits - 1) << "one waits in the mailbox";
    acknowledge(1);
    EXPECT_EQ(drain(), 1);
}

TEST_F(SessionTest, SlowSendingSkipsToTheNewestFrame) {
    configure();
    next(); // Configured
    publish();
    EXPECT_EQ(next().frame_chunk().frame_id(), 1U);
    for (int i = 0; i < 3; ++i) {
        now_ += 10ms;
        publish();
    }
    EXPECT_EQ(dropped(DropReason::kSending), 2U);
    EXPECT_EQ(drain(), 2);
    EXPECT_EQ(session_.counts().frames_sent, 2U);
}

TEST_F(SessionTest, KeepsTheClientsRate) {
    v1::Configure wanted;
    wanted.set_max_frames_per_second(25.0F);
    configure(wanted);
    int sent = 0;
    for (int i = 0; i < 100; ++i) { // one second at 100 frames per second
        now_ += 10ms;
        publish();
        sent += drain();
        acknowledge(frame_id_);
    }
    EXPECT_NEAR(sent, 25, 1); // whether both ends of the second count
    EXPECT_EQ(dropped(DropReason::kRateCap), 100U - static_cast<unsigned>(sent));
}

TEST_F(SessionTest, ReconfiguringAbortsTheFrameBeingSent) {
    configure();
    next();
    publish();
    EXPECT_EQ(next().frame_chunk().frame_id(), 1U);
    v1::Configure wanted;
    wanted.add_modes(v1::DELIVERY_MODE_SCENE);
    configure(wanted);
    const v1::ServerMessage aborted = next();
    EXPECT_EQ(aborted.frame_aborted().frame_id(), 1U);
    EXPECT_EQ(aborted.frame_aborted().reason(), v1::ABORT_REASON_RECONFIGURED);
    EXPECT_EQ(next().configured().epoch(), 2U);
    now_ += 10ms;
    publish();
    EXPECT_EQ(next().frame_chunk().header().planes().planes_size(), 2);
}

TEST_F(SessionTest, SkipsFramesMadeForAnEarlierSelection) {
    configure();
    const feed::FramePtr old = test::synthetic_frame(feed_->info(), feed_->demand(now_), 1, pool_);
    v1::Configure wanted;
    wanted.add_modes(v1::DELIVERY_MODE_SCENE);
    configure(wanted);
    feed_->publish(old);
    EXPECT_EQ(drain(), 0);
    EXPECT_EQ(dropped(DropReason::kReconfigured), 1U);
}

TEST_F(SessionTest, FramesBegunBeforeTheClientCameAreNotDropped) {
    feed_->observe([](const feed::FramePtr&) {}); // the channel runs without it
    const feed::FramePtr begun = test::synthetic_frame(feed_->info(), feed_->demand(now_), 1, pool_);
    configure();
    feed_->publish(begun);
    EXPECT_EQ(drain(), 0) << "it has no views";
    EXPECT_EQ(dropped(DropReason::kReconfigured), 0U);
    frame_id_ = 1;
    publish();
    EXPECT_EQ(drain(), 1);
}

TEST_F(SessionTest, HeartbeatsTellTheNewestFrame) {
    configure();
    publish();
    drain();
    now_ += 500ms;
    const v1::ServerMessage message = next();
    EXPECT_EQ(message.heartbeat().latest_frame_id(), 1U);
    EXPECT_EQ(next().message_case(), v1::ServerMessage::MESSAGE_NOT_SET);
}

TEST_F(SessionTest, StopsReadingWhenAnswersPileUp) {
    v1::ClientMessage message;
    message.mutable_time_sync()->set_client_send_ns(42);
    std::size_t accepted = 0;
    while (session_.accepts_input() && accepted < 1000) {
        session_.on_message(message, now_);
        ++accepted;
    }
    EXPECT_EQ(accepted, kMaxQueuedAnswers);
    EXPECT_EQ(next().time_sync().client_send_ns(), 42);
    EXPECT_TRUE(session_.accepts_input());
}

TEST_F(SessionTest, GoesAwayWithoutFurtherFrames) {
    configure();
    next();
    session_.go_away("night", now_ + 100ms);
    publish();
    EXPECT_EQ(drain(), 1);
    now_ += 100ms;
    EXPECT_EQ(next().going_away().reason(), "night");
    EXPECT_EQ(feed_->subscriber_count(), 0U);
    EXPECT_FALSE(session_.is_overdue(now_));
    EXPECT_TRUE(session_.is_overdue(now_ + Limits{}.going_away_deadline));
}

TEST_F(SessionTest, GoingAwayOvertakesQueuedFramesAndTheRestOfABegunOne) {
    configure();
    next();
    publish();
    EXPECT_TRUE(next().frame_chunk().has_header()); // frame 1 is being written
    publish();                                      // frame 2 is queued
    session_.go_away("night", now_);
    EXPECT_EQ(next().going_away().reason(), "night");
    EXPECT_EQ(dropped(DropReason::kLeaving), 1U);
    EXPECT_EQ(next().frame_chunk().frame_id(), 1U);
    EXPECT_EQ(drain(), 1) << "frame 1 is completed, frame 2 is not begun";
}

TEST_F(SessionTest, GoingAwayDoesNotWaitForCredits) {
    configure();
    next();
    for (std::uint32_t frame = 0; frame < kMinCredits; ++frame) {
        publish();
        EXPECT_EQ(drain(), 1);
    }
    publish(); // has to wait: nothing was acknowledged
    EXPECT_EQ(drain(), 0);
    session_.go_away("night", now_);
    EXPECT_TRUE(next().has_going_away());
    acknowledge(1);
    EXPECT_EQ(drain(), 0) << "the queued frame is gone";
    EXPECT_EQ(dropped(DropReason::kLeaving), 1U);
}

TEST_F(SessionTest, ClientThatNeverConfiguresIsSentAway) {
    now_ += Limits{}.configure_deadline;
    session_.on_tick(now_);
    EXPECT_TRUE(next().has_going_away());
}

TEST_F(SessionTest, ClientThatNeverAcknowledgesIsSentAway) {
    configure();
    publish();
    drain();
    now_ += Limits{}.stall_deadline;
    session_.on_tick(now_);
    EXPECT_TRUE(next().has_going_away());
}

TEST_F(SessionTest, NestedGridsShareViews) {
    const auto other = feed::Feed::subscribe(
        feed_,
        feed::ViewSelection{.format = {.geometry = feed_->info().largest_grid.geometry,
                                   .fovy_rad = feed_->info().fovy_rad,
                                   .width_px = 64,
                                   .height_px = 36},
                        .grid = {.rows = 3, .cols = 3, .geometry = feed_->info().largest_grid.geometry}},
        [](const feed::FramePtr&) {});
    ASSERT_TRUE(other.has_value());
    configure(); // 6×6
    const feed::Demand demand = feed_->demand(now_);
    ASSERT_EQ(demand.views.size(), 1U);
    EXPECT_EQ(demand.views[0].positions.size(), 36U);
}

TEST_F(SessionTest, AnotherLatticeIsAdmittedWithinTheBudgetOnly) {
    configure(); // 36 of 72 views
    next();
    v1::ClientMessage message;
    v1::Grid& grid = *message.mutable_configure()->mutable_grid();
    grid.set_rows(6);
    grid.set_cols(7);
    grid.set_spacing_x_m(0.5F);
    ServerSession second(
        {feed_}, Limits{}, [](const feed::FramePtr&) {}, now_);
    second.on_message(message, now_);
    v1::ServerMessage answer;
    ASSERT_TRUE(answer.ParseFromString(wire::joined(*second.next(now_))));
    EXPECT_EQ(answer.refused().reason(), v1::REFUSAL_REASON_EXHAUSTED);
    EXPECT_NE(answer.refused().message().find(std::to_string(feed_->info().max_view_pixels)), std::string::npos);
}

TEST_F(SessionTest, FramesReferToTheKeyFrameOnceItWasSent) {
    configure_with_key_frames();
    EXPECT_TRUE(feed_->demand(now_).needs_key);
    publish();
    EXPECT_EQ(next_key_frame_id(), 1U);
    EXPECT_FALSE(feed_->demand(now_).needs_key);
    EXPECT_FALSE(feed_->demand(now_).needs_alone);
    publish(1);
    EXPECT_EQ(next_key_frame_id(), 1U);
    acknowledge(1);
    acknowledge(2);
    publish(1);
    EXPECT_EQ(next_key_frame_id(), 1U);
}

TEST_F(SessionTest, WhoJoinsBetweenKeyFramesGetsFramesThatStandAlone) {
    frame_id_ = 10;
    configure_with_key_frames();
    publish(7);
    EXPECT_EQ(next_key_frame_id(), 0U);
    EXPECT_TRUE(feed_->demand(now_).needs_key) << "until it has one";
    publish();
    EXPECT_EQ(next_key_frame_id(), 12U);
}

TEST_F(SessionTest, AFrameThatRefersToAMissedKeyFrameIsDropped) {
    configure_with_key_frames();
    publish();
    EXPECT_EQ(next_key_frame_id(), 1U);
    acknowledge(1);
    publish(); // a key frame that is replaced in the mailbox before it is sent
    publish(2);
    EXPECT_EQ(next().message_case(), v1::ServerMessage::MESSAGE_NOT_SET);
    EXPECT_EQ(dropped(DropReason::kNoKeyFrame), 1U) << "nobody had asked for strips that stand alone";
    EXPECT_TRUE(feed_->demand(now_).needs_alone);
    publish(2);
    EXPECT_EQ(next_key_frame_id(), 0U) << "now they are there";
}

TEST_F(SessionTest, AClientThatFailedToDecodeIsAskedForNothingItLacks) {
    configure_with_key_frames();
    publish();
    EXPECT_EQ(next_key_frame_id(), 1U);
    v1::ClientMessage message;
    message.mutable_frame_ack()->set_frame_id(1);
    message.mutable_frame_ack()->set_epoch(1);
    message.mutable_frame_ack()->set_outcome(v1::FRAME_OUTCOME_FAILED);
    session_.on_message(message, now_);
    EXPECT_TRUE(feed_->demand(now_).needs_key);
    publish(1);
    EXPECT_EQ(next_key_frame_id(), 0U);
}

TEST_F(SessionTest, AClientThatKeepsNoKeyFramesForcesNone) {
    configure();
    drain();
    EXPECT_TRUE(feed_->demand(now_).needs_alone);
    EXPECT_FALSE(feed_->demand(now_).needs_key);
    publish();
    EXPECT_EQ(next_key_frame_id(), 0U);
    publish(1);
    EXPECT_EQ(next_key_frame_id(), 0U);
}

TEST_F(SessionTest, AnotherConfigurationForgetsTheKeyFrame) {
    configure_with_key_frames();
    publish();
    EXPECT_EQ(next_key_frame_id(), 1U);
    configure_with_key_frames();
    EXPECT_TRUE(feed_->demand(now_).needs_key);
    publish(1);
    EXPECT_EQ(next_key_frame_id(), 0U);
}

} // namespace
} // namespace fieldcast::session
