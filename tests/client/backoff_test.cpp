// SPDX-License-Identifier: Apache-2.0
#include "client/net/backoff.h"

#include <gtest/gtest.h>

namespace fieldcast::test {
namespace {

using namespace client::net;
using std::chrono_literals::operator""s;

TEST(Backoff, AsksOftenWhileNobodyAnswersAndSeldomAfterThat) {
    Backoff backoff(7);
    std::chrono::milliseconds longest{0};
    std::chrono::milliseconds sum{0};
    for (int i = 0; i < Backoff::kQuickAttempts; ++i) {
        const auto wait = backoff.next(Obstacle::kUnreachable);
        longest = std::max(longest, wait);
        sum += wait;
    }
    EXPECT_LE(longest, Backoff::kLongestUnreachable);
    EXPECT_GE(sum, 30s) << "a minute, each wait shortened by up to half";
    for (int i = 0; i < 5; ++i) {
        longest = std::max(longest, backoff.next(Obstacle::kUnreachable));
    }
    EXPECT_GE(longest, Backoff::kLongest / 2) << "nobody is waited for in haste for ever";
    backoff.reset();
    EXPECT_LE(backoff.next(Obstacle::kUnreachable), Backoff::kFirst);
}

TEST(Backoff, AServerThatRefusesIsAskedSeldom) {
    Backoff backoff(7);
    std::chrono::milliseconds last{0};
    for (int i = 0; i < 8; ++i) {
        last = backoff.next(Obstacle::kRefused);
    }
    EXPECT_GE(last, Backoff::kLongest / 2);
    EXPECT_LE(backoff.next(Obstacle::kUnreachable), Backoff::kLongestUnreachable) << "it has been started again";
}

} // namespace
} // namespace fieldcast::test
