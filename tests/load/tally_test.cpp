// SPDX-License-Identifier: Apache-2.0
#include "client/load/tally.h"

#include <gmock/gmock.h>

namespace fieldcast::client::load {
namespace {

TEST(JainIndex, IsOneForEqualSharesAndOneNthForAMonopoly) {
    const std::vector<double> equal{2.0, 2.0, 2.0, 2.0};
    const std::vector<double> monopoly{8.0, 0.0, 0.0, 0.0};
    const std::vector<double> half{1.0, 1.0, 0.0, 0.0};
    EXPECT_DOUBLE_EQ(jain_index(equal), 1.0);
    EXPECT_DOUBLE_EQ(jain_index(monopoly), 0.25);
    EXPECT_DOUBLE_EQ(jain_index(half), 0.5);
    EXPECT_DOUBLE_EQ(jain_index({}), 1.0);
    const std::vector<double> nothing{0.0, 0.0};
    EXPECT_DOUBLE_EQ(jain_index(nothing), 1.0);
}

TEST(Tally, SumsEverything) {
    const Window window{.begin_ns = 1'000'000'000, .end_ns = INT64_MAX};
    Tally a;
    a.frames = 3;
    a.connected = 2;
    a.second_of(window, 1'500'000'000).frames = 3;
    a.of(Stage::kDue).add(10);
    a.add_reason("x");
    Tally b;
    b.frames = 4;
    b.lost = 1;
    b.connected = -1;
    b.second_of(window, 3'000'000'000) = {.frames = 4, .bytes = 9, .longest_due_us = 7};
    b.of(Stage::kDue).add(20);
    b.add_reason("x");
    b.add_reason("y");
    a.add(b);
    EXPECT_EQ(a.frames, 7U);
    EXPECT_EQ(a.lost, 1U);
    EXPECT_EQ(a.connected, 1);
    ASSERT_EQ(a.seconds.size(), 3U);
    EXPECT_EQ(a.seconds[0].frames, 3U);
    EXPECT_EQ(a.seconds[2].longest_due_us, 7);
    EXPECT_EQ(a.of(Stage::kDue).count(), 2U);
    EXPECT_EQ(a.reasons.at("x"), 2U);
    EXPECT_EQ(a.reasons.at("y"), 1U);
}

TEST(Tally, KeepsABoundedNumberOfReasons) {
    Tally tally;
    for (int i = 0; i < 100; ++i) {
        tally.add_reason("reason " + std::to_string(i));
    }
    EXPECT_EQ(tally.reasons.size(), Tally::kMaxReasons + 1);
    EXPECT_EQ(tally.reasons.at("others"), 100 - Tally::kMaxReasons);
}

} // namespace
} // namespace fieldcast::client::load
