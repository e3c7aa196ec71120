// SPDX-License-Identifier: Apache-2.0
#include "client/load/scenario.h"

#include "tests/fixtures/test_folder.h"

#include "core/base/error.h"

#include <gmock/gmock.h>

namespace fieldcast::client::load {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ScenarioTest : public testing::Test {
protected:
    Scenario read(const std::string& text) {
        test::write_file(file_, text);
        return read_scenario(file_);
    }

    /// What it says about a file that is wrong.
    std::string problems(const std::string& text) {
        try {
            read(text);
        } catch (const UserError& error) {
            return error.what();
        }
        return "nothing";
    }

    std::string at(int line, const std::string& problem) const {
        return file_.string() + ":" + std::to_string(line) + ": " + problem;
    }

    const test::TestFolder folder_;
    const std::filesystem::path file_ = folder_ / "evening.toml";
};

TEST_F(ScenarioTest, ReadsEverything) {
    const Scenario scenario = read(R"(
ramp = 2.5
duration = 60
seed = 9
threads = 3
metrics = "http://127.0.0.1:9464/metrics"

[target]
address = "https://example.org:50151"
tls-ca = "ca.pem"
token-file = "token.txt"

[thresholds]
due_p99_ms = 250
least_fairness = 0.95

[[group]]
name = "phones"
count = 12
mode = "views"
grid = "2x3"
size = "160x90"
max-fps = 15
due-fps = 10
decoding = "full"
reads-kbit-per-second = 800
think = 0.25
stay = 20
away = 4
leaves = "abruptly"
thresholds = { due_p99_ms = 900, first_frame_max_ms = 3000 }

[[group]]
mode = "scene"
planes = "illumination"
)");
    EXPECT_EQ(scenario.name, "evening");
    EXPECT_EQ(scenario.address, "example.org:50151");
    EXPECT_TRUE(scenario.access.uses_tls);
    EXPECT_EQ(scenario.access.tls_ca, "ca.pem");
    EXPECT_EQ(scenario.access.token_file, "token.txt");
    EXPECT_EQ(scenario.ramp.count(), 2.5);
    EXPECT_EQ(scenario.duration.count(), 60.0);
    EXPECT_EQ(scenario.seed, 9U);
    EXPECT_EQ(scenario.threads, 3U);
    ASSERT_EQ(scenario.thresholds.size(), 2U);
    ASSERT_EQ(scenario.groups.size(), 2U);
    const Group& phones = scenario.groups[0];
    EXPECT_EQ(phones.name, "phones");
    EXPECT_EQ(phones.count, 12U);
    EXPECT_EQ(phones.request.rows, 2U);
    EXPECT_EQ(phones.request.cols, 3U);
    EXPECT_EQ(phones.request.width_px, 160U);
    EXPECT_EQ(phones.request.height_px, 90U);
    EXPECT_EQ(phones.request.max_frames_per_second, 15.0F);
    EXPECT_EQ(phones.due_fps, 10.0);
    EXPECT_EQ(phones.decoding, wire::Decoding::kFull);
    EXPECT_EQ(phones.max_bytes_per_second, 100'000.0);
    EXPECT_EQ(phones.think.count(), 0.25);
    EXPECT_EQ(phones.stay.count(), 20.0);
    EXPECT_EQ(phones.away.count(), 4.0);
    EXPECT_TRUE(phones.leaves_abruptly);
    ASSERT_EQ(phones.thresholds.size(), 2U);
    EXPECT_EQ(std::get<LatencyLimit>(phones.thresholds[1].of).stage, Stage::kFirstFrame);
    EXPECT_EQ(std::get<LatencyLimit>(phones.thresholds[1].of).share, 1.0);
    EXPECT_EQ(phones.thresholds[1].limit, 3000.0);
    EXPECT_EQ(scenario.groups[1].name, "group 2");
    EXPECT_EQ(scenario.groups[1].request.mode, DeliveryMode::kScene);
    EXPECT_EQ(scenario.groups[1].request.planes, PlaneSet::kIllumination);
    EXPECT_EQ(client_count(scenario), 13U);
}

TEST_F(ScenarioTest, NamesFileLineAndKeyOfEveryMistake) {
    const std::string text = problems("ramp = \"a\"\n[[group]]\ncount = 0\ngrid = \"3\"\ncolour = 1\n[thresholds]\n"
                                      "due_p98_ms = 1\n[group.limits]\nx = 1\n[other]\ny = 1\n");
    EXPECT_THAT(text, AllOf(HasSubstr(at(1, "ramp: write a number from 0 to")),
                            HasSubstr(at(3, "count: write a number from 1 to")),
                            HasSubstr(at(4, "grid: write ROWSxCOLS")), HasSubstr(at(5, "colour: no such setting")),
                            HasSubstr(at(7, "due_p98_ms: no such threshold")),
                            HasSubstr(at(8, "limits: unknown table")), HasSubstr(at(10, "other: unknown table"))));
}

TEST_F(ScenarioTest, RefusesValuesThatMakeNoSense) {
    const auto in_group = [&](const std::string& line) { return problems("[[group]]\n" + line + "\n"); };
    EXPECT_THAT(in_group("grid = \"9x9\""), HasSubstr(at(2, "grid: ")));
    EXPECT_THAT(in_group("size = \"0x5\""), HasSubstr(at(2, "size: write WIDTHxHEIGHT")));
    EXPECT_THAT(in_group("count = 1.5"), HasSubstr(at(2, "count: write a whole number")));
    EXPECT_THAT(in_group("count = [1, 2]"), HasSubstr(at(2, "count: write one value")));
    EXPECT_THAT(in_group("think = nan"), HasSubstr(at(2, "think: write a number")));
    for (const char* const rate : {"0.004", "1e-30", "-1", "nan", "inf"}) {
        EXPECT_THAT(in_group("max-fps = " + std::string(rate)), HasSubstr(at(2, "max-fps: write 0, or a number from")));
        EXPECT_THAT(in_group("due-fps = " + std::string(rate)), HasSubstr(at(2, "due-fps: write 0, or a number from")));
    }
    EXPECT_THAT(in_group("stay = -1"), HasSubstr(at(2, "stay: write a number")));
    EXPECT_THAT(in_group("mode = \"mesh\""), HasSubstr(at(2, "mode: write views, scene or warp")));
    EXPECT_THAT(in_group("reads-kbit-per-second = 0"), HasSubstr(at(2, "reads-kbit-per-second: write a number")));
}

TEST_F(ScenarioTest, LooksAtTheWhole) {
    EXPECT_THAT(problems("ramp = 1\n"), HasSubstr("at least one [[group]] is required"));
    EXPECT_THAT(problems("[[group]]\nname = \"a\"\n[[group]]\nname = \"a\"\n"), HasSubstr("group name 'a'"));
    EXPECT_THAT(problems("[[group]]\ncount = 20000\n[[group]]\ncount = 1\n"), HasSubstr("more than 20000 clients"));
    EXPECT_THAT(problems("metrics = \"https://127.0.0.1:1/\"\n[[group]]\n"),
                HasSubstr("metrics https://127.0.0.1:1/: write http"));
    EXPECT_THAT(problems("[target]\ntls-ca = \"a\"\n[[group]]\n"), HasSubstr("need tls"));
    EXPECT_THAT(problems("a = = 1\n"), HasSubstr(file_.string() + ":1: "));
    EXPECT_EQ(problems("[[group]]\n"), "nothing");
}

TEST_F(ScenarioTest, ShippedScenariosAreFine) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("bench/load")) {
        if (entry.path().extension() == ".toml") {
            EXPECT_NO_THROW(read_scenario(entry.path())) << entry.path();
            ++count;
        }
    }
    EXPECT_GE(count, 4U);
}

TEST(Threshold, EveryStageAndPercentileHasAName) {
    for (const StageText& stage : kStages) {
        for (const char* const share : {"p50", "p90", "p95", "p99", "p999", "max"}) {
            const auto threshold = threshold_of(std::string(stage.name) + "_" + share + "_ms", 7.0);
            ASSERT_TRUE(threshold) << stage.name;
            EXPECT_EQ(name_of(std::get<LatencyLimit>(threshold->of).stage), stage.name);
        }
    }
    EXPECT_EQ(std::get<LatencyLimit>(threshold_of("due_p999_ms", 1.0)->of).share, 0.999);
    for (const char* const wrong : {"", "_ms", "p99_ms", "due_p99", "due__ms", "due_p1_ms", "least", "due_p99_ms "}) {
        EXPECT_FALSE(threshold_of(wrong, 1.0)) << wrong;
    }
}

} // namespace
} // namespace fieldcast::client::load
