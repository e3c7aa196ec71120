// SPDX-License-Identifier: Apache-2.0
#include "server/feed/frame_interval.h"
#include "tests/server/synthetic.h"

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <gtest/gtest.h>
#include <limits>
#include <thread>

namespace fieldcast::feed {
namespace {

using namespace std::chrono_literals;

Selection views_selection(const Feed& feed, std::uint32_t rows, std::uint32_t cols) {
    const ChannelInfo& info = feed.info();
    return ViewSelection{
        .format = {.geometry = info.largest_grid.geometry, .fovy_rad = info.fovy_rad, .width_px = 64, .height_px = 36},
        .grid = {.rows = rows, .cols = cols, .geometry = info.largest_grid.geometry}};
}

const Selection kPlanes = PlaneSelection{.choices = {{.semantic = PlaneSemantic::kDiffuse}}};

TEST(FeedTest, DemandIsTheUnionOfSelections) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    EXPECT_TRUE(feed->demand().empty());
    const auto small = Feed::subscribe(feed, views_selection(*feed, 3, 3), [](const FramePtr&) {});
    const auto wide = Feed::subscribe(feed, views_selection(*feed, 1, 6), [](const FramePtr&) {});
    auto planes = Feed::subscribe(feed, kPlanes, [](const FramePtr&) {});
    const Demand demand = feed->demand();
    ASSERT_EQ(demand.views.size(), 1U);
    EXPECT_EQ(demand.views[0].positions.size(), 12U) << "9 + 6 views, 3 of them the same";
    EXPECT_EQ(demand.planes.size(), 1U);
    planes->end();
    EXPECT_TRUE(feed->demand().planes.empty());
}

TEST(FeedTest, NestedGridsShareTheirViews) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    const auto small = Feed::subscribe(feed, views_selection(*feed, 3, 3), [](const FramePtr&) {});
    const auto large = Feed::subscribe(feed, views_selection(*feed, 6, 6), [](const FramePtr&) {});
    const Demand demand = feed->demand();
    EXPECT_EQ(demand.asked_views, 45U);
    ASSERT_EQ(demand.views.size(), 1U);
    EXPECT_EQ(demand.views[0].positions.size(), 36U) << "the nine are among the thirty-six";
}

TEST(FeedTest, RefusedChangeKeepsTheOldSelection) {
    ChannelInfo info = test::synthetic_info();
    info.max_view_pixels = 9ULL * 64 * 36;
    const auto feed = std::make_shared<Feed>(info);
    auto subscription = Feed::subscribe(feed, views_selection(*feed, 3, 3), [](const FramePtr&) {});
    EXPECT_TRUE(subscription->change(views_selection(*feed, 3, 4)).has_value());
    EXPECT_EQ(feed->demand().views[0].positions.size(), 9U);
    EXPECT_FALSE(Feed::subscribe(feed, views_selection(*feed, 4, 4), [](const FramePtr&) {}).has_value());
}

Selection in_quality(Selection selection, std::uint8_t quality) {
    const codec::Encoding encoding{.codec = Codec::kJpeg, .quality = quality};
    if (auto* views = std::get_if<ViewSelection>(&selection)) {
        views->format.encoding = encoding;
    } else {
        std::get<PlaneSelection>(selection).choices.front().encoding = encoding;
    }
    return selection;
}

TEST(FeedTest, EveryEncodingOfViewsCountsInTheBudget) {
    ChannelInfo info = test::synthetic_info();
    info.max_view_pixels = 2 * 9ULL * 64 * 36;
    const auto feed = std::make_shared<Feed>(info);
    const Selection views = views_selection(*feed, 3, 3);
    const auto one = Feed::subscribe(feed, in_quality(views, 40), [](const FramePtr&) {});
    const auto two = Feed::subscribe(feed, in_quality(views, 55), [](const FramePtr&) {});
    const auto same = Feed::subscribe(feed, in_quality(views, 55), [](const FramePtr&) {});
    EXPECT_TRUE(one && two && same);
    const auto third = Feed::subscribe(feed, in_quality(views, 75), [](const FramePtr&) {});
    ASSERT_FALSE(third);
    EXPECT_NE(third.error().find("codec and quality"), std::string::npos) << third.error();
}

TEST(FeedTest, EveryFurtherEncodingOfAPlaneCountsInTheBudget) {
    ChannelInfo info = test::synthetic_info();
    info.max_view_pixels = (64 + 2 + 3) * (36 + 1 + 1);
    const auto feed = std::make_shared<Feed>(info);
    const auto first = Feed::subscribe(feed, kPlanes, [](const FramePtr&) {});
    const auto second = Feed::subscribe(feed, in_quality(kPlanes, 40), [](const FramePtr&) {});
    const auto shared = Feed::subscribe(feed, in_quality(kPlanes, 40), [](const FramePtr&) {});
    EXPECT_TRUE(first && second && shared) << "the first one of a plane is free, the second one fits";
    EXPECT_FALSE(Feed::subscribe(feed, in_quality(kPlanes, 55), [](const FramePtr&) {}));
}

TEST(FeedTest, WaitingBeginsWhenAFrameIsDue) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    feed->set_frames_per_second(0.1F);
    const auto subscription = Feed::subscribe(feed, kPlanes, [](const FramePtr&) {});
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_GE(feed->waiting_time(begin + 5s), 5s) << "the first frame is due at once";
    WorkerPool pool(1);
    feed->publish(test::synthetic_frame(feed->info(), feed->demand(), 1, pool));
    const auto published = std::chrono::steady_clock::now();
    EXPECT_EQ(feed->waiting_time(begin + 10s), 0s) << "at a frame in ten seconds nobody waits that long";
    EXPECT_GE(feed->waiting_time(published + 130s), 120s);
    EXPECT_LT(feed->waiting_time(begin + 130s), 120s + 1ms);
    feed->set_frames_per_second(10.0F);
    EXPECT_GE(feed->waiting_time(published + 5s), 4900ms) << "the rate that holds now counts";
}

TEST(FeedTest, EveryRateHasAnInterval) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float rate : {0.004F, 1e-30F, 0.0F, -1.0F, -kInfinity, std::nanf("")}) {
        EXPECT_NEAR(std::chrono::duration<double>(frame_interval(rate)).count(), 10.0, 1e-6) << rate;
    }
    EXPECT_EQ(frame_interval(kInfinity), 0ns);
    EXPECT_EQ(frame_interval(100.0F), 10ms);
}

TEST(FeedTest, StoppingWakesWhoeverWaitsForDemand) {
    Feed feed(test::synthetic_info());
    std::atomic<bool> has_demand = true;
    std::jthread waiting([&](const std::stop_token& stop) { has_demand = feed.wait_for_demand(stop); });
    waiting.request_stop();
    waiting.join();
    EXPECT_FALSE(has_demand);
}

/// Frames that a subscriber has got.
class Arrivals {
public:
    void count_one() {
        ++*count_.lock();
        came_.notify_all();
    }
    bool wait_for_one() {
        return count_.lock().wait_until(came_, std::chrono::steady_clock::now() + 20s,
                                        [](int count) { return count > 0; });
    }

private:
    std::condition_variable came_;
    Guarded<int> count_;
};

/// For the thread sanitizer: subscribers come, change their minds and go while frames are published.
TEST(FeedTest, SubscribersComeAndGoWhilePublishing) {
    test::SyntheticChannel channel;
    const std::shared_ptr<Feed>& feed = channel.feed();
    std::vector<std::jthread> subscribers;
    for (std::uint32_t i = 0; i < 4; ++i) {
        subscribers.emplace_back([&feed, i] {
            for (int round = 0; round < 5; ++round) {
                const auto frames = std::make_shared<Arrivals>();
                auto subscription = Feed::subscribe(feed, views_selection(*feed, 1, i + 1),
                                                    [frames](const FramePtr&) { frames->count_one(); });
                ASSERT_TRUE(subscription.has_value());
                EXPECT_FALSE(subscription->change(kPlanes).has_value());
                EXPECT_TRUE(frames->wait_for_one());
            }
        });
    }
    subscribers.clear();
    EXPECT_EQ(feed->subscriber_count(), 0U);
}

} // namespace
} // namespace fieldcast::feed
