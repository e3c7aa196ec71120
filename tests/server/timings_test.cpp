// SPDX-License-Identifier: Apache-2.0
// When frames were where, as a session sees it.
#include "server/session/server_session.h"
#include "tests/server/synthetic.h"

#include <gtest/gtest.h>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using timing::DeliveredFrame;
using timing::Outcome;

constexpr std::int64_t kOffset_ns = 5'000'000'000; // the server's clock is so far ahead of the client's

class TimingsTest : public testing::Test {
protected:
    TimingsTest() {
        session_.timings().enable();
        send(configure());
        write_all();
    }

    static v1::ClientMessage configure() {
        v1::ClientMessage message;
        message.mutable_configure();
        return message;
    }

    void send(const v1::ClientMessage& message) { session_.on_message(message, now_); }

    void write_all() {
        while (session_.next(now_)) {
            now_ += 1ms;
        }
    }

    void publish() {
        ++frame_id_;
        feed_->publish(test::synthetic_frame(feed_->info(), feed_->demand(now_), frame_id_, pool_, frame_id_), now_);
    }

    void acknowledge(v1::FrameOutcome outcome, std::int64_t shown_ns = 0) {
        v1::ClientMessage message;
        v1::FrameAck& ack = *message.mutable_frame_ack();
        ack.set_frame_id(frame_id_);
        ack.set_epoch(session_.epoch());
        ack.set_outcome(outcome);
        ack.set_last_byte_ns(100);
        ack.set_decoded_ns(200);
        ack.set_shown_ns(shown_ns);
        ack.mutable_clock()->set_server_minus_client_ns(kOffset_ns);
        ack.mutable_clock()->set_round_trip_ns(40);
        send(message);
    }

    std::vector<DeliveredFrame> finished() { return session_.timings().take_finished(); }

    std::shared_ptr<feed::Feed> feed_ = std::make_shared<feed::Feed>(test::synthetic_info());
    WorkerPool pool_{1};
    TimePoint now_{TimePoint::duration(1h)};
    std::uint64_t frame_id_ = 0;
    ServerSession session_{
        {feed_}, Limits{}, [this](const feed::FramePtr& frame) { session_.on_frame(frame, now_); }, now_};
};

TEST_F(TimingsTest, AShownFrameIsFinishedByItsSecondAcknowledgement) {
    publish();
    write_all();
    acknowledge(v1::FRAME_OUTCOME_DECODED);
    EXPECT_TRUE(finished().empty()) << "it is not known yet when it is shown";
    acknowledge(v1::FRAME_OUTCOME_DECODED, 300);
    const auto records = finished();
    ASSERT_EQ(records.size(), 1U);
    EXPECT_EQ(records[0].outcome, Outcome::kShown);
    EXPECT_EQ(records[0].made.channel, "synthetic");
    EXPECT_EQ(records[0].made.frame_id, frame_id_);
    EXPECT_GT(records[0].send_begin_ns, 0);
    EXPECT_GT(records[0].send_end_ns, records[0].send_begin_ns);
    EXPECT_EQ(records[0].last_byte_ns, kOffset_ns + 100) << "on the server's clock";
    EXPECT_EQ(records[0].shown_ns, kOffset_ns + 300);
    EXPECT_EQ(records[0].first_byte_ns, 0) << "unknown stays unknown";
    EXPECT_EQ(records[0].clock_round_trip_ns, 40);
    EXPECT_GT(records[0].payload_bytes, 0U);
}

TEST_F(TimingsTest, EveryOtherEndIsToldToo) {
    for (const auto& [said, meant] : {std::pair(v1::FRAME_OUTCOME_SUPERSEDED, Outcome::kSuperseded),
                                      std::pair(v1::FRAME_OUTCOME_FAILED, Outcome::kFailed)}) {
        publish();
        write_all();
        acknowledge(said);
        const auto records = finished();
        ASSERT_EQ(records.size(), 1U);
        EXPECT_EQ(records[0].outcome, meant);
    }
    publish();
    session_.next(now_); // its header
    send(configure());   // aborts it
    const auto records = finished();
    ASSERT_EQ(records.size(), 1U);
    EXPECT_EQ(records[0].outcome, Outcome::kAborted);
}

TEST_F(TimingsTest, AFrameThatNobodySpeaksOfIsFinishedAtTheEnd) {
    publish();
    write_all();
    EXPECT_TRUE(finished().empty());
    session_.end();
    const auto records = finished();
    ASSERT_EQ(records.size(), 1U);
    EXPECT_EQ(records[0].outcome, Outcome::kUnacknowledged);
}

TEST_F(TimingsTest, KeepsABoundedNumber) {
    constexpr std::uint64_t kMany = 3 * FrameTimings::kMaxPending;
    for (std::uint64_t i = 0; i < kMany; ++i) {
        publish();
        write_all();
        acknowledge(v1::FRAME_OUTCOME_DECODED); // never shown
    }
    EXPECT_EQ(finished().size(), FrameTimings::kMaxPending) << "nobody took them meanwhile";
    EXPECT_TRUE(finished().empty());
}

TEST_F(TimingsTest, NothingIsKeptUnlessAskedFor) {
    FrameTimings timings;
    const auto frame = test::synthetic_frame(feed_->info(), feed_->demand(now_), 1, pool_);
    timings.begun({1, 1}, "synthetic", *frame, 10);
    timings.end();
    EXPECT_TRUE(timings.take_finished().empty());
}

TEST(FeedObserver, SeesFramesThatItDoesNotAskFor) {
    const auto feed = std::make_shared<feed::Feed>(test::synthetic_info());
    std::vector<std::uint64_t> seen;
    feed->observe([&](const feed::FramePtr& frame) { seen.push_back(frame->header.frame_id); });
    EXPECT_TRUE(feed->demand().empty()) << "an observer wants nothing";
    WorkerPool pool(1);
    feed->publish(test::synthetic_frame(feed->info(), feed->demand(), 5, pool));
    EXPECT_EQ(seen, std::vector<std::uint64_t>{5});
}

} // namespace
} // namespace fieldcast::session
