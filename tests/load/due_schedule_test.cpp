// SPDX-License-Identifier: Apache-2.0
#include "client/load/due_schedule.h"

#include <gtest/gtest.h>

namespace fieldcast::client::load {
namespace {

using std::chrono_literals::operator""ms;

constexpr std::int64_t kMs = 1'000'000; // nanoseconds
constexpr Window kAlways{.begin_ns = 0, .end_ns = INT64_MAX};

TEST(DueSchedule, ASteadyStreamTakesItsLatencyAndThePhase) {
    DueSchedule due(3 * kMs, 100ms);
    LatencyHistogram latencies;
    for (int frame = 0; frame <= 50; ++frame) { // posed every 100 ms, visible 40 ms later
        due.answer(frame * 100 * kMs, (frame * 100 + 40) * kMs, kAlways, latencies);
    }
    EXPECT_EQ(latencies.count(), 50U);
    EXPECT_EQ(latencies.largest_us(), 137'000); // 97 ms to the next pose, and 40 ms
    EXPECT_EQ(latencies.percentile_us(0.0), latencies.largest_us());
}

TEST(DueSchedule, AStallCountsForEveryMomentThatItCovers) {
    DueSchedule due(0, 10ms);
    LatencyHistogram latencies;
    for (int frame = 0; frame < 100; ++frame) {
        due.answer(frame * 10 * kMs, frame * 10 * kMs, kAlways, latencies);
    }
    EXPECT_EQ(latencies.largest_us(), 0);
    due.answer(1990 * kMs, 1990 * kMs, kAlways, latencies); // nothing for a second
    EXPECT_EQ(latencies.count(), 200U);
    EXPECT_EQ(latencies.largest_us(), 990'000);
    EXPECT_NEAR(static_cast<double>(latencies.percentile_us(0.75)), 490'000.0, 500.0); // half of the stall's moments
}

TEST(DueSchedule, AFrameDoesNotShowMomentsAfterItsPose) {
    DueSchedule due(0, 10ms);
    LatencyHistogram latencies;
    due.answer(25 * kMs, 300 * kMs, kAlways, latencies); // moments 0, 10 and 20
    EXPECT_EQ(latencies.count(), 3U);
    EXPECT_EQ(latencies.largest_us(), 300'000);
    due.answer(20 * kMs, 310 * kMs, kAlways, latencies); // an older pose answers nothing new
    EXPECT_EQ(latencies.count(), 3U);
}

TEST(DueSchedule, APoseInTheFutureIsAClockOutOfStep) {
    DueSchedule due(0, 10ms);
    LatencyHistogram latencies;
    due.answer(90 * kMs, 30 * kMs, kAlways, latencies);
    EXPECT_EQ(latencies.count(), 4U); // 0, 10, 20, 30
}

TEST(DueSchedule, OnlyTheWindowCounts) {
    DueSchedule due(0, 10ms);
    LatencyHistogram latencies;
    const Window window{.begin_ns = 50 * kMs, .end_ns = 80 * kMs};
    EXPECT_EQ(due.answer(40 * kMs, 45 * kMs, window, latencies), 0);
    EXPECT_EQ(due.answer(200 * kMs, 200 * kMs, window, latencies), 150'000);
    EXPECT_EQ(latencies.count(), 3U); // 50, 60, 70
}

TEST(DueSchedule, AStallAtTheEndIsNotForgotten) {
    DueSchedule due(0, 10ms);
    LatencyHistogram latencies;
    due.answer(100 * kMs, 130 * kMs, kAlways, latencies); // 0 … 100: at most 130 ms
    const std::uint64_t before = latencies.count();
    EXPECT_EQ(due.cut_off(230 * kMs, kAlways, latencies), 0U); // 110 has waited for 120 ms: that is usual
    EXPECT_EQ(due.cut_off(1110 * kMs, kAlways, latencies), 87U); // 110 … 970 have waited for more than 130 ms
    EXPECT_EQ(latencies.count(), before + 87);
    EXPECT_EQ(latencies.largest_us(), 1'000'000);
}

} // namespace
} // namespace fieldcast::client::load
