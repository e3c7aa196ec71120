// SPDX-License-Identifier: Apache-2.0
// For whom a channel makes frames: for those who could take them.
#include "server/session/server_session.h"
#include "tests/server/synthetic.h"

#include <atomic>
#include <gtest/gtest.h>
#include <map>
#include <thread>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using feed::Feed;
using feed::Pace;
using std::chrono::milliseconds;

constexpr TimePoint kStart{1h};

/// Of a width that no selection for another number of views has, so that none are shared.
feed::Selection views_selection(const Feed& feed, std::uint32_t rows) {
    const feed::ChannelInfo& info = feed.info();
    return feed::ViewSelection{.format = {.geometry = info.largest_grid.geometry,
                                      .fovy_rad = info.fovy_rad,
                                      .width_px = 64 - rows,
                                      .height_px = 36},
                           .grid = {.rows = rows, .cols = 1, .geometry = info.largest_grid.geometry}};
}

std::size_t views_in(const feed::Demand& demand) {
    std::size_t count = 0;
    for (const feed::ViewDemand& views : demand.views) {
        count += views.positions.size();
    }
    return count;
}

void ignore(const feed::FramePtr& /*frame*/) {}

TEST(PaceTest, WithoutACapEveryFrameIsDue) {
    Pace pace;
    pace.take(kStart);
    EXPECT_TRUE(pace.is_due(kStart));
}

TEST(PaceTest, FramesAreAQuarterEarlyAtMost) {
    Pace pace(100ms);
    EXPECT_TRUE(pace.is_due(kStart));
    pace.take(kStart);
    EXPECT_FALSE(pace.is_due(kStart + 74ms));
    EXPECT_TRUE(pace.is_due(kStart + 75ms));
    pace.take(kStart + 75ms);
    EXPECT_FALSE(pace.is_due(kStart + 174ms)) << "what came early is not gained";
    EXPECT_TRUE(pace.is_due(kStart + 175ms));
}

TEST(PaceTest, WhatWasMissedIsNotMadeUp) {
    Pace pace(100ms);
    pace.take(kStart);
    pace.take(kStart + 10s);
    EXPECT_FALSE(pace.is_due(kStart + 10s + 50ms));
}

TEST(DemandTest, ASelectionWithoutRoomDoesNotCount) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    const auto small = Feed::subscribe(feed, views_selection(*feed, 2), ignore);
    auto large = Feed::subscribe(feed, views_selection(*feed, 6), ignore);
    EXPECT_EQ(views_in(feed->demand(kStart)), 8U);
    large->set_room({.taken_until = kStart});
    const feed::Demand later = feed->demand(kStart + 1s);
    EXPECT_EQ(views_in(later), 2U);
    EXPECT_EQ(later.asked_views, 2U);
    large->set_room({});
    EXPECT_EQ(views_in(feed->demand(kStart + 1s)), 8U) << "at once";
}

TEST(DemandTest, ASelectionCountsAgainWhenRoomIsExpected) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    auto subscription = Feed::subscribe(feed, views_selection(*feed, 2), ignore);
    subscription->set_room({.taken_until = kStart + 10s});
    EXPECT_TRUE(feed->demand(kStart).empty());
    EXPECT_FALSE(feed->demand(kStart).is_awaited) << "10 s are longer than the averages of the source need";
    EXPECT_TRUE(feed->demand(kStart + 9'500ms).is_awaited);
    EXPECT_FALSE(feed->demand(kStart + 10s).empty());
    EXPECT_TRUE(feed->demand(kStart + 11s).empty()) << "it did not come";
    EXPECT_FALSE(feed->demand(kStart + 11s).is_awaited);
}

TEST(DemandTest, ACappedSelectionCountsAtItsPace) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    const auto free = Feed::subscribe(feed, views_selection(*feed, 2), ignore);
    const auto capped = Feed::subscribe(feed, views_selection(*feed, 6), ignore, Pace(1s));
    int counted = 0;
    for (int i = 0; i < 1000; ++i) { // ten seconds
        const std::size_t views = views_in(feed->demand(kStart + i * 10ms));
        EXPECT_TRUE(views == 2 || views == 8);
        counted += views == 8 ? 1 : 0;
    }
    EXPECT_EQ(counted, 11) << "at 0 s, a quarter early, and once a second";
}

TEST(DemandTest, TheChannelSleepsWhileNobodyHasRoom) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    auto subscription = Feed::subscribe(feed, views_selection(*feed, 2), ignore);
    subscription->set_room({.taken_until = std::chrono::steady_clock::now() - 1h});
    std::atomic<int> has_demand = -1;
    std::jthread channel([&](const std::stop_token& stop) { has_demand = feed->wait_for_demand(stop) ? 1 : 0; });
    channel.request_stop();
    channel.join();
    EXPECT_EQ(has_demand, 0) << "only stopping woke it";
    channel = std::jthread([&](const std::stop_token& stop) { has_demand = feed->wait_for_demand(stop) ? 1 : 0; });
    subscription->set_room({});
    channel.join();
    EXPECT_EQ(has_demand, 1);
}

TEST(DemandTest, WhoHasNoRoomOrIsNotDueWaitsForNothing) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    const auto now = std::chrono::steady_clock::now();
    auto subscription = Feed::subscribe(feed, views_selection(*feed, 2), ignore);
    EXPECT_GE(feed->waiting_time(now + 1h), 59min);
    subscription->set_room({.taken_until = now});
    EXPECT_EQ(feed->waiting_time(now + 1h), 0ns);
    subscription->set_room({});
    EXPECT_FALSE(subscription->change(views_selection(*feed, 2), Pace(2h)).has_value());
    EXPECT_FALSE(feed->demand(now).empty());
    EXPECT_EQ(feed->waiting_time(now + 1h), 0ns) << "the next frame is due in two hours";
    EXPECT_GE(feed->waiting_time(now + 3h), 59min);
}

/// One client of a channel that has 100 frames per second, each ready 20 ms after it was begun.
class ClientRun {
public:
    struct Manners {
        milliseconds acknowledges_after{0};
        milliseconds sending_takes{0};
        bool acknowledges = true;
        float max_frames_per_second = 0.0F; ///< 0: no cap
    };
    struct Result {
        int made = 0; ///< frames with its views
        int made_last = 0; ///< in the last second
        int sent = 0;
        int sent_later = 0;        ///< after the first second, when the round trip is known
        milliseconds age_later{0}; ///< from the beginning of these frames to that of their sending, summed up
    };

    /// `makes_all`: frames have its views whether it could take them or not, as a comparison.
    Result run(const Manners& manners, bool makes_all, milliseconds duration) {
        v1::ClientMessage configure;
        configure.mutable_configure()->set_max_frames_per_second(manners.max_frames_per_second);
        configure.mutable_configure()->mutable_grid()->set_rows(1);
        configure.mutable_configure()->mutable_grid()->set_cols(1);
        session_.on_message(configure, now_);
        feed::Demand demand;
        feed::add(demand, session_.configuration()->selection);
        WorkerPool pool(1);
        frame_ = test::synthetic_frame(feed_->info(), demand, 1, pool, 1);
        const auto end = now_ + duration;
        for (; now_ < end; now_ += 1ms) {
            if ((now_ - kStart) % 10ms == 0ms) {
                begin_frame(makes_all);
                result_.made_last += is_made_ && now_ >= end - 1s ? 1 : 0;
            }
            deliver();
            write(manners);
        }
        return result_;
    }

private:
    void begin_frame(bool makes_all) {
        is_made_ = !feed_->demand(now_).empty() || makes_all;
        if (!is_made_) {
            return;
        }
        ++result_.made;
        begun_[++frame_id_] = now_;
        auto frame = std::make_shared<feed::EncodedFrame>(*frame_);
        frame->begun = now_;
        frame->header.frame_id = frame->key_frame_id = frame_id_;
        frame->views.at(0).header.frame_id = frame->views.at(0).key_frame_id = frame_id_;
        ready_.emplace(now_ + 20ms, std::move(frame));
    }

    void deliver() {
        for (; !ready_.empty() && ready_.begin()->first <= now_; ready_.erase(ready_.begin())) {
            feed_->publish(ready_.begin()->second, now_);
        }
        for (; !acks_.empty() && acks_.begin()->first <= now_; acks_.erase(acks_.begin())) {
            session_.on_message(acks_.begin()->second, now_);
        }
    }

    /// Whatever is small goes at once; a frame keeps the link busy from its header to its trailer.
    void write(const Manners& manners) {
        v1::ServerMessage message;
        while (now_ >= link_free_) {
            const auto chunk = session_.next(now_);
            if (!chunk) {
                return;
            }
            EXPECT_TRUE(message.ParseFromString(wire::joined(*chunk)));
            if (message.frame_chunk().has_header()) {
                ++result_.sent;
                count_later(message.frame_chunk().frame_id());
                link_free_ = now_ + manners.sending_takes;
            } else if (message.frame_chunk().has_trailer() && manners.acknowledges) {
                v1::ClientMessage ack;
                ack.mutable_frame_ack()->set_frame_id(message.frame_chunk().frame_id());
                ack.mutable_frame_ack()->set_epoch(session_.epoch());
                acks_.emplace(now_ + manners.acknowledges_after, ack);
            }
        }
    }

    void count_later(std::uint64_t frame_id) {
        if (now_ >= kStart + 1s) {
            ++result_.sent_later;
            result_.age_later += std::chrono::duration_cast<milliseconds>(now_ - begun_.at(frame_id));
        }
    }

    TimePoint now_ = kStart;
    TimePoint link_free_{};
    Result result_;
    bool is_made_ = false;
    std::uint64_t frame_id_ = 0;
    feed::FramePtr frame_; ///< all frames, but for their ids
    std::map<std::uint64_t, TimePoint> begun_;
    std::multimap<TimePoint, feed::FramePtr> ready_;
    std::multimap<TimePoint, v1::ClientMessage> acks_;
    std::shared_ptr<Feed> feed_ = std::make_shared<Feed>(test::synthetic_info());
    ServerSession session_{
        {feed_}, Limits{}, [this](const feed::FramePtr& frame) { session_.on_frame(frame, now_); }, now_};
};

ClientRun::Result run(const ClientRun::Manners& manners, bool makes_all = false, milliseconds duration = 10s) {
    return ClientRun().run(manners, makes_all, duration);
}

TEST(DemandOfASessionTest, NothingIsMadeForAClientThatDoesNotAcknowledge) {
    const ClientRun::Result result = run({.acknowledges = false});
    EXPECT_EQ(result.sent, static_cast<int>(kMinCredits));
    EXPECT_LE(result.made, 12) << "those on the way and those that were begun while it could have acknowledged them";
    EXPECT_EQ(result.made_last, 0);
}

TEST(DemandOfASessionTest, NothingIsMadeForAClientThatDoesNotRead) {
    const ClientRun::Result result = run({.sending_takes = 1h});
    EXPECT_EQ(result.sent, 1);
    EXPECT_LE(result.made, 12);
    EXPECT_EQ(result.made_last, 0);
}

TEST(DemandOfASessionTest, FramesAreMadeAtTheRateThatAClientAskedFor) {
    const ClientRun::Result result = run({.acknowledges_after = 5ms, .max_frames_per_second = 1.0F});
    EXPECT_EQ(result.sent, 11);
    EXPECT_EQ(result.made, 11);
    EXPECT_EQ(run({.acknowledges_after = 5ms, .max_frames_per_second = 30.0F}).sent,
              run({.acknowledges_after = 5ms, .max_frames_per_second = 30.0F}, true).sent);
}

/// Round trips that eight credits cover at 100 frames per second, and sending that keeps up.
TEST(DemandOfASessionTest, AHealthyClientGetsWhatItWouldGetIfAllFramesWereMadeForIt) {
    for (const milliseconds ack : {0ms, 1ms, 5ms, 9ms, 10ms, 11ms, 19ms, 20ms, 25ms, 35ms, 45ms, 60ms, 70ms}) {
        for (const milliseconds sending : {0ms, 5ms, 9ms, 10ms}) {
            const ClientRun::Manners manners{.acknowledges_after = ack, .sending_takes = sending};
            const ClientRun::Result result = run(manners, false, 3s);
            const ClientRun::Result all = run(manners, true, 3s);
            EXPECT_EQ(result.sent_later, all.sent_later) << ack.count() << " ms, " << sending.count() << " ms";
            EXPECT_EQ(result.age_later, all.age_later) << ack.count() << " ms, " << sending.count() << " ms";
        }
    }
}

/// Who is slower than the channel gets as many frames as it can take. They have waited little longer, measured by how long
/// they are on the way, and few are made in vain: the reserve, and those around the expected time.
TEST(DemandOfASessionTest, ASlowClientGetsAsManyFramesAsItCanTake) {
    for (const milliseconds ack : {5ms, 100ms, 250ms, 700ms}) {
        for (const milliseconds sending : {0ms, 12ms, 33ms, 47ms, 80ms, 150ms, 400ms}) {
            const ClientRun::Manners manners{.acknowledges_after = ack, .sending_takes = sending};
            const ClientRun::Result result = run(manners);
            const ClientRun::Result all = run(manners, true);
            SCOPED_TRACE(std::to_string(ack.count()) + " ms, " + std::to_string(sending.count()) + " ms");
            EXPECT_GE(result.sent, all.sent - 2);
            EXPECT_LE(result.made, 6 * result.sent + 5);
            EXPECT_LE(result.age_later / result.sent_later, all.age_later / all.sent_later + 1ms + (ack + sending) / 8);
        }
    }
}

} // namespace
} // namespace fieldcast::session
