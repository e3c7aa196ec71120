// SPDX-License-Identifier: Apache-2.0
#include "core/base/rate_limit.h"

#include <gtest/gtest.h>

namespace fieldcast {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

const RateLimit::TimePoint kStart{100s};

int taken(RateLimit& limit, RateLimit::TimePoint now, int tries) {
    int count = 0;
    for (int i = 0; i < tries; ++i) {
        count += limit.take(now) ? 1 : 0;
    }
    return count;
}

TEST(RateLimit, LetsABurstThroughAndThenTheRate) {
    RateLimit limit({.per_second = 10.0, .burst = 5.0});
    EXPECT_EQ(taken(limit, kStart, 20), 5);
    EXPECT_EQ(taken(limit, kStart + 90ms, 20), 0);
    EXPECT_EQ(taken(limit, kStart + 310ms, 20), 3);
    EXPECT_EQ(taken(limit, kStart + 60s, 20), 5);
}

TEST(RateLimit, AnEventMayCountAsSeveral) {
    RateLimit limit({.per_second = 10.0, .burst = 5.0});
    EXPECT_TRUE(limit.take(kStart, 0.0));
    EXPECT_TRUE(limit.take(kStart, 4.5));
    EXPECT_FALSE(limit.take(kStart, 0.6)) << "and takes nothing";
    EXPECT_TRUE(limit.take(kStart, 0.5));
    EXPECT_TRUE(limit.take(kStart, 0.0)) << "nothing always goes";
}

TEST(RateLimit, AverageOverALongTimeIsTheRate) {
    RateLimit limit({.per_second = 7.0, .burst = 3.0});
    int count = 0;
    for (int i = 0; i <= 10'000; ++i) { // ten seconds
        count += taken(limit, kStart + i * 1ms, 2);
    }
    EXPECT_NEAR(count, 3 + 70, 1); // one for the rounding of 10000 additions
}

TEST(RateLimit, IsIdleWhenTheBurstIsWholeAgain) {
    RateLimit limit({.per_second = 10.0, .burst = 5.0});
    EXPECT_TRUE(limit.is_idle(kStart));
    taken(limit, kStart, 5);
    EXPECT_FALSE(limit.is_idle(kStart + 490ms));
    EXPECT_TRUE(limit.is_idle(kStart + 510ms));
}

} // namespace
} // namespace fieldcast
