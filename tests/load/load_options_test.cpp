// SPDX-License-Identifier: Apache-2.0
#include "client/load_options.h"

#include "tests/fixtures/test_folder.h"

#include <cstdlib>
#include <gmock/gmock.h>

namespace fieldcast::client {
namespace {

using testing::HasSubstr;

LoadInvocation read(std::vector<const char*> words) {
    ::unsetenv("FIELDCAST_TOKEN");
    words.insert(words.begin(), "fieldcast-load");
    return read_load_options(static_cast<int>(words.size()), words.data());
}

TEST(LoadOptions, TheCommonestCaseNeedsNoFile) {
    const LoadInvocation invocation =
        read({"--clients", "20", "--grid", "3x2", "--mode", "views", "--duration", "12.5", "127.0.0.1:4444"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    const load::Scenario& scenario = invocation.options->scenario;
    EXPECT_EQ(scenario.address, "127.0.0.1:4444");
    EXPECT_EQ(scenario.duration, load::Seconds(12.5));
    ASSERT_EQ(scenario.groups.size(), 1U);
    EXPECT_EQ(scenario.groups[0].count, 20U);
    EXPECT_EQ(scenario.groups[0].request.rows, 3U);
    EXPECT_EQ(scenario.groups[0].request.cols, 2U);
    EXPECT_EQ(scenario.groups[0].decoding, wire::Decoding::kChecksum);
}

TEST(LoadOptions, FlagsWinOverTheFile) {
    const test::TestFolder folder;
    const auto file = folder / "a.toml";
    test::write_file(file, "ramp = 3\nduration = 5\n[target]\naddress = \"a.example.org:1\"\n[[group]]\ncount = 2\n");
    const LoadInvocation invocation = read({"--scenario", file.c_str(), "--ramp", "0", "https://b.example.org:2"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    const load::Scenario& scenario = invocation.options->scenario;
    EXPECT_EQ(scenario.ramp.count(), 0.0);
    EXPECT_EQ(scenario.duration.count(), 5.0);
    EXPECT_EQ(scenario.address, "b.example.org:2");
    EXPECT_TRUE(scenario.access.uses_tls);
    EXPECT_EQ(scenario.groups.at(0).count, 2U);
    EXPECT_THAT(read({"--scenario", file.c_str(), "--clients", "3"}).text,
                HasSubstr("--clients: not allowed with --scenario"));
}

TEST(LoadOptions, NamesTheFlagThatIsWrong) {
    EXPECT_EQ(read({"--clients", "0"}).exit_code, 2);
    EXPECT_THAT(read({"--clients", "0"}).text, HasSubstr("--clients 0: write a number from 1 to"));
    EXPECT_THAT(read({"--grid", "9x9"}).text, HasSubstr("--grid 9x9: "));
    EXPECT_THAT(read({"--mode", "mesh"}).text, HasSubstr("--mode mesh: write views, scene or warp"));
    EXPECT_THAT(read({"--duration", "soon"}).text, HasSubstr("--duration soon: write a number"));
    EXPECT_THAT(read({"--require", "due_p98_ms=3"}).text, HasSubstr("--require due_p98_ms=3: no such threshold"));
    EXPECT_THAT(read({"--require", "due_p99_ms"}).text, HasSubstr("write a number"));
    EXPECT_THAT(read({"--metrics", "http://example.org:80/metrics"}).text, HasSubstr("must be this machine"));
    EXPECT_THAT(read({"--tls-cert", "a.pem"}).text, HasSubstr("must be given together"));
    EXPECT_EQ(read({"--nonsense"}).exit_code, 2);
}

TEST(LoadOptions, TakesThresholds) {
    const LoadInvocation invocation = read({"--require", "due_p99_ms=300", "--require", "least_fps=2"});
    ASSERT_TRUE(invocation.options) << invocation.text;
    const auto& thresholds = invocation.options->scenario.thresholds;
    ASSERT_EQ(thresholds.size(), 2U);
    EXPECT_EQ(thresholds[0].name, "due_p99_ms");
    EXPECT_EQ(thresholds[0].limit, 300.0);
    EXPECT_EQ(std::get<load::Quantity>(thresholds[1].of), load::Quantity::kLeastFps);
}

TEST(LoadOptions, HelpHasExamples) {
    const LoadInvocation invocation = read({"--help"});
    EXPECT_EQ(invocation.exit_code, 0);
    EXPECT_THAT(invocation.text, HasSubstr("fieldcast-load --clients 20 --grid 3x3"));
}

TEST(LoadOptions, TakesTheTokenFromTheEnvironment) {
    ::setenv("FIELDCAST_TOKEN", "secret", 1);
    const char* const words[] = {"fieldcast-load"};
    const LoadInvocation invocation = read_load_options(1, words);
    ::unsetenv("FIELDCAST_TOKEN");
    ASSERT_TRUE(invocation.options);
    EXPECT_EQ(invocation.options->scenario.access.token, "secret");
}

} // namespace
} // namespace fieldcast::client
