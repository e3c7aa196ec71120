// SPDX-License-Identifier: Apache-2.0
// What decides how many frames are on the way, and which.
#include "server/session/credits.h"
#include "server/session/mailbox.h"

#include <gtest/gtest.h>
#include <optional>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;

TEST(MailboxTest, NewestWins) {
    Mailbox<int> mailbox;
    EXPECT_EQ(mailbox.put(1), std::nullopt);
    EXPECT_EQ(mailbox.put(2), 1);
    EXPECT_EQ(mailbox.take(), 2);
    EXPECT_EQ(mailbox.take(), std::nullopt);
}

TEST(CreditsTest, StaysBetweenTwoAndEight) {
    Credits credits(30.0, 1000);
    const TimePoint start{};
    EXPECT_EQ(credits.limit(), 2U);
    credits.spend({1, 1}, 10, start);
    credits.sent({1, 1}, start);
    EXPECT_TRUE(credits.acknowledged({1, 1}, 0ms, start + 10s)); // a round trip of 300 frames
    EXPECT_EQ(credits.limit(), 8U);
}

TEST(CreditsTest, FollowsRoundTripAndDecodeTime) {
    Credits credits(30.0, 1000);
    const TimePoint start{};
    credits.spend({1, 1}, 10, start);
    credits.sent({1, 1}, start);
    EXPECT_TRUE(credits.acknowledged({1, 1}, 0ms, start + 90ms));
    EXPECT_EQ(credits.min_round_trip(), 90ms);
    EXPECT_EQ(credits.limit(), 4U); // ceil(30 · 0.09) + 1
}

TEST(CreditsTest, CapsFramesAndBytes) {
    Credits credits(30.0, 100);
    EXPECT_TRUE(credits.allow(1000)); // alone, a large frame may go
    credits.spend({1, 1}, 60, {});
    EXPECT_FALSE(credits.allow(60));
    EXPECT_TRUE(credits.allow(40));
    credits.spend({1, 2}, 40, {});
    EXPECT_FALSE(credits.allow(0));
    credits.give_back({1, 1});
    EXPECT_TRUE(credits.allow(60));
}

TEST(CreditsTest, ReturnsACreditOnce) {
    Credits credits(30.0, 100);
    credits.spend({1, 7}, 10, {});
    EXPECT_FALSE(credits.acknowledged({1, 7}, 0ms, {})) << "not sent completely";
    credits.sent({1, 7}, {});
    EXPECT_FALSE(credits.acknowledged({2, 7}, 0ms, {})) << "another epoch";
    EXPECT_TRUE(credits.acknowledged({1, 7}, 0ms, {}));
    EXPECT_FALSE(credits.acknowledged({1, 7}, 0ms, {}));
}

} // namespace
} // namespace fieldcast::session
