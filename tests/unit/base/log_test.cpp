// SPDX-License-Identifier: Apache-2.0
#include "core/base/log.h"

#include <functional>
#include <gmock/gmock.h>
#include <limits>
#include <thread>
#include <vector>

namespace fieldcast::log {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

std::string lines_of(const std::function<void()>& write) {
    testing::internal::CaptureStderr();
    write();
    return testing::internal::GetCapturedStderr();
}

struct Log : testing::Test {
    ~Log() override {
        set_level(Level::kInfo);
        set_format(Format::kText);
    }
};

TEST_F(Log, WritesOneJsonObjectPerLine) {
    set_format(Format::kJson);
    const std::string line = lines_of([] {
        info("session opened", {{"peer", "a \"b\" \\ \n\x01\xFF"}, {"views", 36}, {"ms", 1.5}, {"cut", true}});
    });
    EXPECT_THAT(line, MatchesRegex("\\{\"time\":\"....-..-..T..:..:..\\....Z\",\"level\":\"info\",.*\n"));
    EXPECT_THAT(line, EndsWith(R"(,"event":"session opened","peer":"a \"b\" \\ \u000a\u0001)"
                               "\xEF\xBF\xBD"
                               R"(","views":36,"ms":1.5,"cut":true})"
                               "\n"));
}

TEST_F(Log, JsonHasNoNumbersThatAreNone) {
    set_format(Format::kJson);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_THAT(lines_of([&] {
                    info("e", {{"a", infinity}, {"b", -infinity}, {"c", infinity - infinity}});
                }),
                MatchesRegex(".*\"a\":\"inf\",\"b\":\"-inf\",\"c\":\"-?nan\"\\}\n"));
}

TEST_F(Log, StartsWithTimeLevelAndEvent) {
    const std::string line = lines_of([] { info("session opened", {{"peer", "10.0.0.7"}, {"views", 36}}); });
    EXPECT_THAT(line, MatchesRegex("....-..-..T..:..:..\\.... info +session opened peer=10.0.0.7 views=36\n"));
}

TEST_F(Log, FormatsNumbersAndTruth) {
    const std::string line = lines_of([] {
        info("frame", {{"ms", 1.25}, {"cut", true}, {"id", 18446744073709551615ULL}, {"n", -3}});
    });
    EXPECT_THAT(line, EndsWith(" frame ms=1.25 cut=true id=18446744073709551615 n=-3\n"));
}

TEST_F(Log, QuotesValuesThatWouldBreakTheLine) {
    EXPECT_THAT(lines_of([] {
                    warn("peer", {{"name", "\x1b[2J"}});
                }),
                MatchesRegex(".* warning +peer name=\" .2J\"\n"));
    const std::string line = lines_of([] { warn("refused", {{"name", "a b"}, {"why", "x=\"1\"\ny"}, {"empty", ""}}); });
    EXPECT_THAT(line, EndsWith(" refused name=\"a b\" why=\"x=\\\"1\\\" y\" empty=\"\"\n"));
}

TEST_F(Log, TakesFormatCharactersLiterally) {
    EXPECT_THAT(lines_of([] { error("{} %s {0", {{"file", "{}%n"}}); }), EndsWith(" {} %s {0 file={}%n\n"));
}

TEST_F(Log, LeavesOutWhatIsBelowTheLevel) {
    EXPECT_EQ(lines_of([] { debug("frame"); }), "");
    set_level(Level::kDebug);
    EXPECT_THAT(lines_of([] { debug("frame"); }), HasSubstr("debug"));
    set_level(Level::kError);
    EXPECT_EQ(lines_of([] { warn("slow"); }), "");
    EXPECT_THAT(lines_of([] { error("lost"); }), MatchesRegex(".* error +lost\n"));
}

TEST_F(Log, LinesOfThreadsDoNotMix) {
    const std::string lines = lines_of([] {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i) {
            threads.emplace_back([] {
                for (int round = 0; round < 50; ++round) {
                    info("tick", {{"round", round}});
                }
            });
        }
    });
    EXPECT_EQ(std::ranges::count(lines, '\n'), 200);
    std::size_t events = 0;
    for (std::size_t at = lines.find(" tick round="); at != std::string::npos;
         at = lines.find(" tick round=", at + 1)) {
        ++events;
    }
    EXPECT_EQ(events, 200U);
}

} // namespace
} // namespace fieldcast::log
