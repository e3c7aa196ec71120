// SPDX-License-Identifier: Apache-2.0
#include "client/load/load_result.h"
#include "client/load/result_files.h"

#include "tests/fixtures/test_folder.h"

#include "core/base/error.h"
#include "tests/unit/report/html_check.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace fieldcast::client::load {
namespace {

using testing::HasSubstr;
using testing::Not;

Threshold threshold(const std::string& name, double limit) {
    return *threshold_of(name, limit);
}

GroupResult group_of_two(const std::string& name, std::vector<double> client_fps) {
    GroupResult result;
    result.group.name = name;
    result.group.count = 2;
    result.fairness = jain_index(client_fps);
    result.client_fps = std::move(client_fps);
    return result;
}

/// Two groups: "a<b>" with latencies of 1 … 100 ms, "starved" with a client that got nothing.
LoadResult two_groups() {
    LoadResult result;
    result.scenario.name = "test & co";
    result.seconds = 10.0;
    result.cpu_seconds = 1.0;
    GroupResult good = group_of_two("a<b>", {5.0, 5.0});
    for (int ms = 1; ms <= 100; ++ms) {
        good.tally.of(Stage::kDue).add(ms * 1000);
    }
    good.tally.frames = 100;
    good.tally.bytes = 5'000'000;
    good.tally.seconds.resize(10, Second{.frames = 10, .bytes = 500'000, .longest_due_us = 100'000});
    good.tally.add_reason("sent away: \x01\xFF");
    GroupResult bad = group_of_two("starved", {4.0, 0.0});
    bad.tally.frames = 40;
    bad.tally.lost = 3;
    result.groups = {good, bad};
    result.scenario.groups = {good.group, bad.group};
    result.metrics_before = {{"frames_total", 5.0}, {"still", 1.0}};
    result.metrics_after = {{"frames_total", 145.0}, {"still", 1.0}};
    return result;
}

bool holds(const LoadResult& result, std::size_t group, const std::string& name, double limit) {
    Scenario scenario = result.scenario;
    scenario.thresholds = {threshold(name, limit)};
    return checks_of(scenario, result.groups).at(group).holds;
}

TEST(LoadResult, ThresholdsAreCompared) {
    const LoadResult result = two_groups();
    EXPECT_TRUE(holds(result, 0, "due_p50_ms", 51.0));
    EXPECT_FALSE(holds(result, 0, "due_p50_ms", 49.0));
    EXPECT_TRUE(holds(result, 0, "due_max_ms", 100.0));
    EXPECT_FALSE(holds(result, 0, "due_max_ms", 99.0));
    EXPECT_TRUE(holds(result, 0, "least_fps", 5.0));
    EXPECT_FALSE(holds(result, 0, "least_fps", 5.1));
    EXPECT_FALSE(holds(result, 1, "least_fps", 0.1));
    EXPECT_TRUE(holds(result, 0, "least_fairness", 1.0));
    EXPECT_FALSE(holds(result, 1, "least_fairness", 0.51));
    EXPECT_TRUE(holds(result, 1, "most_lost", 3.0));
    EXPECT_FALSE(holds(result, 1, "most_lost", 2.0));
    EXPECT_FALSE(holds(result, 1, "most_without_frames", 0.0));
    EXPECT_TRUE(holds(result, 0, "most_without_frames", 0.0));
}

TEST(LoadResult, ALatencyThatNobodyMeasuredIsMissed) {
    EXPECT_FALSE(holds(two_groups(), 1, "due_p99_ms", 1e9));
}

TEST(LoadResult, AGroupsThresholdTakesThePlaceOfTheCommonOne) {
    LoadResult result = two_groups();
    Scenario scenario = result.scenario;
    scenario.thresholds = {threshold("least_fps", 100.0)};
    result.groups[0].group.thresholds = {threshold("least_fps", 1.0)};
    result.checks = checks_of(scenario, result.groups);
    ASSERT_EQ(result.checks.size(), 2U);
    EXPECT_TRUE(result.checks[0].holds);
    EXPECT_FALSE(result.checks[1].holds);
    EXPECT_FALSE(result.holds());
    result.checks.pop_back();
    EXPECT_TRUE(result.holds());
    result.groups[0].tally.frames = result.groups[1].tally.frames = 0;
    EXPECT_FALSE(result.holds()); // nobody got anything
}

TEST(LoadResult, JsonHasTheNumbers) {
    LoadResult result = two_groups();
    result.checks = {{.group = "starved", .threshold = threshold("least_fps", 1.0), .measured = 0.0, .holds = false}};
    const auto json = nlohmann::json::parse(to_json(result));
    EXPECT_EQ(json["groups"][0]["name"], "a<b>");
    EXPECT_EQ(json["groups"][0]["stages"]["due"]["count"], 100);
    EXPECT_NEAR(json["groups"][0]["stages"]["due"]["p90_ms"].get<double>(), 90.0, 0.1); // a bucket is 0.1 % wide
    EXPECT_EQ(json["groups"][0]["bytes_per_second"], 500'000.0);
    EXPECT_EQ(json["groups"][0]["seconds"].size(), 10U);
    EXPECT_EQ(json["groups"][1]["clients_without_frames"], 1);
    EXPECT_EQ(json["groups"][1]["fairness"], 0.5);
    EXPECT_EQ(json["cpu_percent_per_client"], 2.5); // one second of ten, by four clients
    EXPECT_EQ(json["thresholds"][0]["holds"], false);
    EXPECT_EQ(json["holds"], false);
    EXPECT_EQ(json["server_metrics"]["frames_total"]["after"], 145.0);
}

TEST(LoadResult, ThePageStandsAloneAndEscapes) {
    const std::string html = to_html(two_groups());
    EXPECT_THAT(html, HasSubstr("a&lt;b&gt;"));
    EXPECT_THAT(html, Not(HasSubstr("a<b>")));
    EXPECT_THAT(html, HasSubstr("Load: test &amp; co"));
    EXPECT_THAT(html, HasSubstr("<polyline"));
    EXPECT_THAT(html, HasSubstr("140.000")); // change of frames_total
    EXPECT_THAT(html, Not(HasSubstr("still")));
    EXPECT_EQ(test::html_problem(html), "");
}

TEST(LoadResult, APageWithoutAnyFrameIsStillAPage) {
    LoadResult result = two_groups();
    result.seconds = 0.0;
    for (GroupResult& group : result.groups) {
        group.tally = Tally();
        group.client_fps.clear();
    }
    EXPECT_THAT(to_html(result), HasSubstr("nothing was measured"));
    EXPECT_THAT(to_html(result), Not(HasSubstr("nan")));
    EXPECT_FALSE(to_table(result).empty());
    EXPECT_TRUE(nlohmann::json::accept(to_json(result)));
}

TEST(LoadResult, WritesADistributionPerStageThatHasOne) {
    const test::TestFolder folder;
    write_hgrm(two_groups(), folder / "out");
    const std::string text = test::text_of(folder / "out/a_b_.due.hgrm");
    EXPECT_THAT(text, HasSubstr("#[Max     =      100.000, Total count    =          100]"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out/starved.due.hgrm"));
    test::write_file(folder / "file", "");
    EXPECT_THROW(write_hgrm(two_groups(), folder / "file/out"), UserError);
    EXPECT_THROW(write_json(two_groups(), folder / "none/a.json"), UserError);
}

} // namespace
} // namespace fieldcast::client::load
