// SPDX-License-Identifier: Apache-2.0
// Memory of the device that clients make the server take.
#include "server/session/server_session.h"
#include "tests/server/synthetic.h"

#include <gmock/gmock.h>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using feed::Feed;
using feed::ViewMemory;
using testing::HasSubstr;

constexpr std::uint64_t kBytesPerPixel = 100;
constexpr std::uint64_t kBytesPerView = kBytesPerPixel * 64 * 36;

/// Of `views` views; the four that the renderer may add count too.
constexpr std::uint64_t bytes_of(std::uint64_t views) {
    return (views + 4) * kBytesPerView;
}

class ViewMemoryTest : public testing::Test {
protected:
    std::shared_ptr<Feed> make_feed() const {
        feed::ChannelInfo info = test::synthetic_info();
        info.bytes_per_view_pixel = kBytesPerPixel;
        info.view_memory = memory_;
        return std::make_shared<Feed>(info);
    }

    static tl::expected<feed::Subscription, std::string> subscribe(const std::shared_ptr<Feed>& feed,
                                                                   const feed::Selection& selection) {
        return Feed::subscribe(feed, selection, [](const feed::FramePtr&) {});
    }

    static feed::Selection selection(const Feed& feed, std::uint32_t cols, std::uint32_t width_px = 64) {
        const feed::ChannelInfo& info = feed.info();
        return feed::ViewSelection{.format = {.geometry = info.largest_grid.geometry,
                                          .fovy_rad = info.fovy_rad,
                                          .width_px = width_px,
                                          .height_px = 36},
                               .grid = {.rows = 1, .cols = cols, .geometry = info.largest_grid.geometry}};
    }

    const std::shared_ptr<ViewMemory> memory_ = std::make_shared<ViewMemory>(bytes_of(6));
    std::shared_ptr<Feed> feed_ = make_feed();
};

TEST_F(ViewMemoryTest, WhatDoesNotFitIsRefusedWithTheNumbers) {
    auto small = subscribe(feed_, selection(*feed_, 3));
    ASSERT_TRUE(small.has_value());
    EXPECT_EQ(memory_->used(), bytes_of(3));
    const auto other = make_feed();
    const auto refused = subscribe(other, selection(*other, 3));
    ASSERT_FALSE(refused.has_value()) << "all channels share the budget";
    EXPECT_THAT(refused.error(), HasSubstr(std::to_string(bytes_of(3)) + " more bytes"));
    EXPECT_THAT(refused.error(),
                HasSubstr(std::to_string(bytes_of(3)) + " of " + std::to_string(bytes_of(6)) + " are in use"));
    EXPECT_TRUE(small->change(selection(*feed_, 7)).has_value());
    EXPECT_EQ(memory_->used(), bytes_of(3)) << "refused: it keeps what it had";
    EXPECT_FALSE(small->change(selection(*feed_, 6)).has_value());
    EXPECT_TRUE(subscribe(feed_, selection(*feed_, 3)).has_value()) << "its views are there";
    EXPECT_EQ(memory_->used(), bytes_of(6));
}

TEST_F(ViewMemoryTest, WhatIsLeftCountsUntilTheChannelHasForgottenIt) {
    auto first = subscribe(feed_, selection(*feed_, 6));
    ASSERT_TRUE(first.has_value());
    EXPECT_FALSE(feed_->surplus(std::chrono::steady_clock::now() + 1h).has_value());
    first->end();
    EXPECT_EQ(memory_->used(), bytes_of(6)) << "the channel still has it";
    EXPECT_FALSE(subscribe(feed_, selection(*feed_, 3, 32)).has_value());
    EXPECT_TRUE(subscribe(feed_, selection(*feed_, 6)).has_value()) << "the same views need no more";
    EXPECT_FALSE(feed_->surplus(std::chrono::steady_clock::now()).has_value()) << "not at once";
    const auto kept = feed_->surplus(std::chrono::steady_clock::now() + Feed::kKeepViews);
    ASSERT_TRUE(kept.has_value());
    EXPECT_TRUE(kept->empty());
    feed_->forgot_all_but(*kept);
    EXPECT_EQ(memory_->used(), 0U);
    EXPECT_TRUE(subscribe(feed_, selection(*feed_, 3, 32)).has_value());
}

TEST_F(ViewMemoryTest, TheChannelIsWokenToForget) {
    auto first = subscribe(feed_, selection(*feed_, 6));
    ASSERT_TRUE(first.has_value());
    first->end();
    EXPECT_TRUE(feed_->wait_for_demand({})) << "although nobody wants a frame";
    const auto kept = feed_->surplus(std::chrono::steady_clock::now());
    ASSERT_TRUE(kept.has_value());
}

TEST_F(ViewMemoryTest, AFeedThatGoesGivesAllBack) {
    {
        const auto subscription = subscribe(feed_, selection(*feed_, 6));
        ASSERT_TRUE(subscription.has_value());
        feed_.reset();
        EXPECT_EQ(memory_->used(), bytes_of(6));
    }
    EXPECT_EQ(memory_->used(), 0U);
}

TEST_F(ViewMemoryTest, ASessionIsToldThatMemoryIsExhausted) {
    const TimePoint now{1h};
    ServerSession session(
        {feed_}, Limits{}, [](const feed::FramePtr&) {}, now);
    v1::ClientMessage message;
    message.mutable_configure()->mutable_grid()->set_rows(1);
    message.mutable_configure()->mutable_grid()->set_cols(7);
    session.on_message(message, now);
    v1::ServerMessage answer;
    ASSERT_TRUE(answer.ParseFromString(wire::joined(*session.next(now))));
    EXPECT_EQ(answer.refused().reason(), v1::REFUSAL_REASON_EXHAUSTED);
    EXPECT_THAT(answer.refused().message(), HasSubstr("of the device's memory"));
}

} // namespace
} // namespace fieldcast::session
