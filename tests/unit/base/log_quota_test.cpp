// SPDX-License-Identifier: Apache-2.0
#include "core/base/log_quota.h"

#include <algorithm>
#include <functional>
#include <gmock/gmock.h>
#include <memory>
#include <thread>
#include <vector>

namespace fieldcast::log {
namespace {

using std::chrono_literals::operator""s;
using testing::HasSubstr;
using testing::Not;

const Quota::TimePoint kStart{100s};
constexpr RateLimit::Rate kRate{.per_second = 1.0, .burst = 3.0};

std::string written(const std::function<void()>& write) {
    testing::internal::CaptureStderr();
    write();
    return testing::internal::GetCapturedStderr();
}

std::ptrdiff_t lines_in(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}

TEST(LogQuota, LeavesLinesOutAndSaysHowMany) {
    const std::string text = written([] {
        Quota lines("session 7", kRate);
        for (int i = 0; i < 50; ++i) {
            lines.write(Level::kInfo, "steering begins", {{"lease", i}}, kStart);
        }
        lines.write(Level::kInfo, "steering begins", {{"lease", 50}}, kStart + 1s);
    });
    EXPECT_EQ(lines_in(text), 5) << text;
    EXPECT_THAT(text, HasSubstr("steering begins lease=2\n"));
    EXPECT_THAT(text, HasSubstr("log lines left out of=\"steering begins\" by=\"session 7\" count=47\n"));
    EXPECT_THAT(text, HasSubstr("steering begins lease=50\n"));
}

TEST(LogQuota, EveryEventHasItsOwnShare) {
    const std::string text = written([] {
        Quota lines("session 7", kRate);
        for (int i = 0; i < 9; ++i) {
            lines.write(Level::kInfo, "one", {}, kStart);
        }
        lines.write(Level::kWarn, "another", {}, kStart);
    });
    EXPECT_THAT(text, HasSubstr("warning another\n"));
}

TEST(LogQuota, TheEndSaysWhatWasLeftOut) {
    auto lines = std::make_unique<Quota>("session 7", kRate);
    const std::string during = written([&] {
        for (int i = 0; i < 5; ++i) {
            lines->write(Level::kInfo, "one", {}, kStart);
        }
        lines->write(Level::kInfo, "two", {}, kStart);
    });
    EXPECT_THAT(during, Not(HasSubstr("left out")));
    const std::string at_end = written([&] { lines.reset(); });
    EXPECT_EQ(lines_in(at_end), 1) << at_end;
    EXPECT_THAT(at_end, HasSubstr("of=one by=\"session 7\" count=2"));
}

TEST(LogQuota, ThreadsShareIt) {
    const std::string text = written([] {
        Quota lines("everybody", kRate);
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i) {
            threads.emplace_back([&lines] {
                for (int n = 0; n < 100; ++n) {
                    lines.write(Level::kInfo, "one", {}, kStart);
                }
            });
        }
        threads.clear();
    });
    EXPECT_EQ(lines_in(text), 3 + 1) << text;
    EXPECT_THAT(text, HasSubstr("count=397"));
}

} // namespace
} // namespace fieldcast::log
