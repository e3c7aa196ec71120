// SPDX-License-Identifier: Apache-2.0
#include "bench/progress.h"

#include <gtest/gtest.h>

namespace fieldcast::bench {
namespace {

using std::chrono::seconds;

TEST(Progress, DurationsAreRoundedToMinutes) {
    EXPECT_EQ(describe_duration(seconds(0)), "less than a minute");
    EXPECT_EQ(describe_duration(seconds(29)), "less than a minute");
    EXPECT_EQ(describe_duration(seconds(30)), "1 min");
    EXPECT_EQ(describe_duration(seconds(59 * 60 + 29)), "59 min");
    EXPECT_EQ(describe_duration(seconds(59 * 60 + 30)), "1 h 0 min");
    EXPECT_EQ(describe_duration(seconds(27 * 3600 + 600)), "27 h 10 min");
}

TEST(Progress, SaysOnceThatAllIsDone) {
    testing::internal::CaptureStderr();
    {
        Progress progress("frames", 2.0);
        progress.add(1.0);
        progress.add(1.0);
        progress.add(1.0);
    }
    const std::string text = testing::internal::GetCapturedStderr();
    const std::size_t first = text.find("frames: 100 % after less than a minute");
    ASSERT_NE(first, std::string::npos) << text;
    EXPECT_EQ(text.find("100 %", first + 15), std::string::npos) << text;
}

} // namespace
} // namespace fieldcast::bench
