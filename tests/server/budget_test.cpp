// SPDX-License-Identifier: Apache-2.0
// What sessions of one peer share, and what a session does when it is used up.
#include "server/session/quality_rungs.h"
#include "server/session/server_session.h"
#include "tests/server/synthetic.h"

#include <gtest/gtest.h>
#include <thread>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;

TEST(BudgetTest, GivesAllOrNothing) {
    Budget budget(10);
    EXPECT_TRUE(budget.take(6));
    EXPECT_FALSE(budget.take(5));
    EXPECT_EQ(budget.used(), 6U);
    EXPECT_TRUE(budget.take(4));
    budget.give_back(10);
    EXPECT_EQ(budget.used(), 0U);
}

TEST(BudgetTest, WhatIsTooLargeGoesAlone) {
    Budget budget(10);
    EXPECT_TRUE(budget.take(100));
    EXPECT_FALSE(budget.take(1));
    budget.give_back(100);
    EXPECT_TRUE(budget.take(1));
    EXPECT_FALSE(budget.take(100));
}

TEST(BudgetTest, TheParentLimitsAllChildren) {
    const auto parent = std::make_shared<Budget>(10);
    Budget one(8, parent);
    Budget two(8, parent);
    EXPECT_TRUE(one.take(7));
    EXPECT_FALSE(two.take(7));
    EXPECT_EQ(two.used(), 0U) << "what the parent refused was not taken";
    EXPECT_TRUE(two.take(3));
    one.give_back(7);
    EXPECT_EQ(parent->used(), 3U);
}

TEST(BudgetTest, TheLastEighthIsForWhoHasNothing) {
    const auto parent = std::make_shared<Budget>(16);
    Budget one(15, parent);
    Budget two(15, parent);
    Budget three(15, parent);
    EXPECT_TRUE(one.take(12));
    EXPECT_TRUE(two.take(1));
    EXPECT_FALSE(one.take(2)) << "14 of 16 for those that have something";
    EXPECT_TRUE(one.take(1));
    EXPECT_FALSE(two.take(1));
    EXPECT_TRUE(three.take(2)) << "it has nothing yet";
    EXPECT_FALSE(three.take(1));
    EXPECT_EQ(parent->used(), 16U);
}

TEST(BudgetTest, NothingIsKeptWhereOneMayHaveAll) {
    const auto parent = std::make_shared<Budget>(16);
    Budget one(16, parent);
    EXPECT_TRUE(one.take(12));
    EXPECT_TRUE(one.take(4));
}

TEST(BudgetTest, SharesEndWithTheirHolder) {
    const auto budget = std::make_shared<Budget>(10);
    {
        Share share(budget);
        EXPECT_TRUE(share.resize(8));
        EXPECT_TRUE(share.resize(3));
        EXPECT_EQ(budget->used(), 3U);
        EXPECT_FALSE(share.resize(11));
        EXPECT_EQ(budget->used(), 3U);
    }
    EXPECT_EQ(budget->used(), 0U);
    EXPECT_TRUE(Share().resize(1ULL << 60U)) << "a share of nothing";
}

TEST(BudgetTest, ManyThreadsNeverTakeTooMuch) {
    const auto budget = std::make_shared<Budget>(3);
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 5'000; ++k) {
                if (budget->take(2)) {
                    EXPECT_LE(budget->used(), 3U);
                    budget->give_back(2);
                }
            }
        });
    }
    threads.clear();
    EXPECT_EQ(budget->used(), 0U);
}

/// As many sessions as there are qualities, each with its own in that codec; what the channel encodes for them.
feed::Demand demand_of_all_qualities(v1::DeliveryMode mode, v1::PlaneSemantic semantic, v1::Codec codec) {
    feed::ChannelInfo info = test::synthetic_info();
    info.max_view_pixels = 1ULL << 40U; // rungs alone have to bound it
    const auto feed = std::make_shared<feed::Feed>(info);
    const TimePoint now{1h};
    std::vector<std::unique_ptr<ServerSession>> sessions;
    for (std::uint32_t quality = 1; quality <= kMaxQuality; ++quality) {
        v1::ClientMessage message;
        v1::Configure& wanted = *message.mutable_configure();
        wanted.add_modes(mode);
        v1::CodecPreference& preference = *wanted.add_codecs();
        preference.set_semantic(semantic);
        preference.add_codecs(codec);
        preference.set_quality(quality);
        sessions.push_back(std::make_unique<ServerSession>(
            std::vector{feed}, Limits{}, [](const feed::FramePtr&) {}, now));
        sessions.back()->on_message(message, now);
        EXPECT_TRUE(sessions.back()->configuration()) << quality;
    }
    return feed->demand();
}

TEST(EncodingsTest, AHundredQualitiesAreSixEncodings) {
    for (const v1::Codec codec : {v1::CODEC_JPEG, v1::CODEC_H264}) {
        const auto views = demand_of_all_qualities(v1::DELIVERY_MODE_VIEWS, v1::PLANE_SEMANTIC_COLOUR, codec);
        EXPECT_EQ(views.views.size(), kQualityRungs.size()) << v1::Codec_Name(codec);
    }
    const auto scene =
        demand_of_all_qualities(v1::DELIVERY_MODE_SCENE, v1::PLANE_SEMANTIC_DIFFUSE, v1::CODEC_JPEG);
    EXPECT_EQ(scene.repeated_planes(), kQualityRungs.size() - 1) << "and one of specular light";
}

/// Two sessions of one peer.
class SharedBudgetTest : public testing::Test {
protected:
    std::unique_ptr<ServerSession> open() {
        return std::make_unique<ServerSession>(
            std::vector{feed_}, limits_, [](const feed::FramePtr&) {}, now_, budgets_);
    }

    static v1::ClientMessage configure(std::uint32_t rows) {
        v1::ClientMessage message;
        message.mutable_configure()->mutable_grid()->set_rows(rows);
        message.mutable_configure()->mutable_grid()->set_cols(2);
        return message;
    }

    /// Hands a new frame to the session and writes all it can; the number of complete frames.
    int send_frame(ServerSession& session) {
        ++frame_id_;
        session.on_frame(test::synthetic_frame(feed_->info(), feed_->demand(now_), frame_id_, pool_, frame_id_), now_);
        return drain(session);
    }

    int drain(ServerSession& session) {
        int trailers = 0;
        v1::ServerMessage message;
        for (auto chunk = session.next(now_); chunk; chunk = session.next(now_)) {
            EXPECT_TRUE(message.ParseFromString(wire::joined(*chunk)));
            trailers += message.frame_chunk().has_trailer() ? 1 : 0;
            last_ = message;
        }
        return trailers;
    }

    void acknowledge(ServerSession& session, std::uint64_t frame_id) {
        v1::ClientMessage message;
        message.mutable_frame_ack()->set_frame_id(frame_id);
        message.mutable_frame_ack()->set_epoch(session.epoch());
        session.on_message(message, now_);
    }

    const Limits limits_{.max_pixels_per_peer = 5 * 64 * 36, .max_messages_per_second = 100.0};
    const TimePoint now_{1h};
    std::uint64_t frame_id_ = 0;
    WorkerPool pool_{1};
    v1::ServerMessage last_;
    const std::shared_ptr<feed::Feed> feed_ = std::make_shared<feed::Feed>(test::synthetic_info());
    const PeerBudgets budgets_{.bytes = std::make_shared<Budget>(1),
                               .pixels = std::make_shared<Budget>(limits_.max_pixels_per_peer)};
};

TEST_F(SharedBudgetTest, FramesWaitForBytesOfOtherSessions) {
    const auto one = open();
    auto two = open();
    one->on_message(configure(1), now_);
    two->on_message(configure(1), now_);
    EXPECT_EQ(send_frame(*one), 1) << "more than the limit, but alone";
    EXPECT_EQ(budgets_.bytes->used(), one->credits().bytes_in_flight());
    EXPECT_EQ(send_frame(*two), 0);
    EXPECT_EQ(send_frame(*two), 0);
    EXPECT_EQ(two->counts().drops.of(DropReason::kNoBudget), 1U) << "a newer one took its place";
    EXPECT_EQ(two->counts().drops.of(DropReason::kNoCredit), 0U);
    acknowledge(*one, 1);
    EXPECT_EQ(budgets_.bytes->used(), 0U);
    EXPECT_EQ(drain(*two), 1) << "the frame that waited";
    EXPECT_GT(budgets_.bytes->used(), 0U);
    two->end();
    EXPECT_EQ(budgets_.bytes->used(), 0U);
}

TEST_F(SharedBudgetTest, PixelsOfAllSessionsOfAPeerCount) {
    const auto one = open();
    auto two = open();
    one->on_message(configure(2), now_); // 4 of 5 views
    two->on_message(configure(2), now_);
    drain(*two);
    EXPECT_EQ(last_.refused().reason(), v1::REFUSAL_REASON_EXHAUSTED);
    EXPECT_EQ(last_.refused().field(), "grid");
    EXPECT_NE(last_.refused().message().find(std::to_string(limits_.max_pixels_per_peer)), std::string::npos);
    one->on_message(configure(1), now_); // 2
    EXPECT_EQ(budgets_.pixels->used(), 2U * 64 * 36);
    two->on_message(configure(1), now_);
    drain(*two);
    EXPECT_TRUE(two->configuration().has_value());
    two.reset();
    EXPECT_EQ(budgets_.pixels->used(), 2U * 64 * 36);
    v1::ClientMessage scene = configure(2);
    scene.mutable_configure()->add_modes(v1::DELIVERY_MODE_SCENE);
    one->on_message(scene, now_);
    EXPECT_EQ(budgets_.pixels->used(), 0U) << "its views are its own work";
}

TEST_F(SharedBudgetTest, ASessionCountsItsMessages) {
    const auto session = open();
    v1::ClientMessage ack;
    ack.mutable_frame_ack()->set_frame_id(7);
    for (int i = 0; i < 200; ++i) { // twice the rate at once
        session->on_message(ack, now_);
        ASSERT_FALSE(session->is_flooded()) << i;
    }
    session->on_message(ack, now_ + 5ms);
    EXPECT_TRUE(session->is_flooded());
}

TEST_F(SharedBudgetTest, ConfigureCountsAsManyMessages) {
    const auto session = open();
    for (int i = 0; i < 200 / kConfigureWeight; ++i) {
        session->on_message(configure(1), now_);
        drain(*session);
        ASSERT_FALSE(session->is_flooded()) << i;
    }
    session->on_message(configure(1), now_);
    EXPECT_TRUE(session->is_flooded());
    EXPECT_EQ(drain(*session), 0) << "and is not answered";
}

} // namespace
} // namespace fieldcast::session
