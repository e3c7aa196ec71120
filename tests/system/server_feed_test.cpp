// SPDX-License-Identifier: Apache-2.0
#include "server_synthetic.h"

#include <atomic>
#include <gtest/gtest.h>
#include <thread>

namespace fieldcast::feed {
namespace {

using namespace std::chrono_literals;

Wish views_wish(const Feed& feed, std::uint32_t rows, std::uint32_t cols) {
    const ChannelInfo& info = feed.info();
    return ViewsWish{
        .format = {.geometry = info.largest_grid.geometry, .fovy_rad = info.fovy_rad, .width_px = 64, .height_px = 36},
        .grid = {.rows = rows, .cols = cols, .geometry = info.largest_grid.geometry}};
}

const Wish kPlanes = PlanesWish{.choices = {{.semantic = PlaneSemantic::kDiffuse}}};

TEST(FeedTest, DemandIsTheUnionOfWishes) {
    const auto feed = std::make_shared<Feed>(test::synthetic_info());
    EXPECT_TRUE(feed->demand().empty());
    const auto small = Feed::subscribe(feed, views_wish(*feed, 3, 3), [](const FramePtr&) {});
    const auto wide = Feed::subscribe(feed, views_wish(*feed, 1, 6), [](const FramePtr&) {});
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
    const auto small = Feed::subscribe(feed, views_wish(*feed, 3, 3), [](const FramePtr&) {});
    const auto large = Feed::subscribe(feed, views_wish(*feed, 6, 6), [](const FramePtr&) {});
    const Demand demand = feed->demand();
    EXPECT_EQ(demand.asked_views, 45U);
    ASSERT_EQ(demand.views.size(), 1U);
    EXPECT_EQ(demand.views[0].positions.size(), 36U) << "the nine are among the thirty-six";
}

TEST(FeedTest, RefusedChangeKeepsTheOldWish) {
    ChannelInfo info = test::synthetic_info();
    info.max_view_pixels = 9ULL * 64 * 36;
    const auto feed = std::make_shared<Feed>(info);
    auto subscription = Feed::subscribe(feed, views_wish(*feed, 3, 3), [](const FramePtr&) {});
    EXPECT_TRUE(subscription->change(views_wish(*feed, 3, 4)).has_value());
    EXPECT_EQ(feed->demand().views[0].positions.size(), 9U);
    EXPECT_FALSE(Feed::subscribe(feed, views_wish(*feed, 4, 4), [](const FramePtr&) {}).has_value());
}

TEST(FeedTest, StoppingWakesWhoeverWaitsForDemand) {
    Feed feed(test::synthetic_info());
    std::atomic<bool> has_demand = true;
    std::jthread waiting([&](const std::stop_token& stop) { has_demand = feed.wait_for_demand(stop); });
    waiting.request_stop();
    waiting.join();
    EXPECT_FALSE(has_demand);
}

/// For the thread sanitizer: subscribers come, change their minds and go while frames are published.
TEST(FeedTest, SubscribersComeAndGoWhilePublishing) {
    test::SyntheticChannel channel;
    const std::shared_ptr<Feed>& feed = channel.feed();
    std::vector<std::jthread> subscribers;
    for (std::uint32_t i = 0; i < 4; ++i) {
        subscribers.emplace_back([&feed, i] {
            for (int round = 0; round < 5; ++round) {
                const auto frames = std::make_shared<std::atomic<int>>(0);
                auto subscription =
                    Feed::subscribe(feed, views_wish(*feed, 1, i + 1), [frames](const FramePtr&) { ++*frames; });
                ASSERT_TRUE(subscription.has_value());
                EXPECT_FALSE(subscription->change(kPlanes).has_value());
                const auto deadline = std::chrono::steady_clock::now() + 20s;
                while (*frames == 0 && std::chrono::steady_clock::now() < deadline) {
                    std::this_thread::yield();
                }
                EXPECT_GT(*frames, 0);
            }
        });
    }
    subscribers.clear();
    EXPECT_EQ(feed->subscriber_count(), 0U);
}

} // namespace
} // namespace fieldcast::feed
