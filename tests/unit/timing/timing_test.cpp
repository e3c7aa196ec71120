// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/timing/log_text.h"
#include "core/timing/timing_recorder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

namespace fieldcast::timing {
namespace {

using testing::HasSubstr;

/// Frame `id`, begun `id` · 10 ms after 1 s, with a millisecond between all moments.
DeliveredFrame frame_at(std::uint64_t id) {
    const std::int64_t begin_ns = 1'000'000'000 + static_cast<std::int64_t>(id) * 10'000'000;
    const auto after = [&](int ms) { return begin_ns + ms * 1'000'000; };
    DeliveredFrame frame;
    frame.made = {.channel = "hall, \"east\"",
                  .frame_id = id,
                  .scene_time_ns = 40,
                  .pose_sampled_ns = after(0),
                  .render_begin_ns = after(1),
                  .render_end_ns = after(6),
                  .encode_begin_ns = after(7),
                  .encode_end_ns = after(8),
                  .stages = {{"trace", 2.5}, {"denoise", 1.25}}};
    frame.client = 7;
    frame.epoch = 2;
    frame.outcome = Outcome::kShown;
    frame.payload_bytes = 1234;
    frame.send_begin_ns = after(9);
    frame.send_end_ns = after(10);
    frame.first_byte_ns = after(11);
    frame.last_byte_ns = after(30); // 20 ms: still on the way when the next frames are sent
    frame.decoded_ns = after(31);
    frame.shown_ns = after(33);
    frame.clock_round_trip_ns = 2'000'000;
    return frame;
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

/// Fields of RFC 4180 without line breaks in them.
std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields(1);
    bool is_quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool is_doubled = is_quoted && line[i] == '"' && i + 1 < line.size() && line[i + 1] == '"';
        if (is_doubled) {
            fields.back() += line[i++];
        } else if (line[i] == '"') {
            is_quoted = !is_quoted;
        } else if (line[i] == ',' && !is_quoted) {
            fields.emplace_back();
        } else {
            fields.back() += line[i];
        }
    }
    return fields;
}

class Timing : public testing::Test {
protected:
    Timing() {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~Timing() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("fieldcast_timing_" + std::to_string(getpid()));
};

TEST_F(Timing, CsvRowsFitTheirHeader) {
    const auto file = folder_ / "frames.csv";
    { TimingRecorder({.frame_log = file, .trace = {}}).add(frame_at(3)); }
    const auto lines = lines_of(file);
    ASSERT_EQ(lines.size(), 2U);
    const auto names = fields_of(lines[0]);
    const auto values = fields_of(lines[1]);
    ASSERT_EQ(names.size(), values.size());
    const auto value = [&](const char* name) {
        const auto column = std::find(names.begin(), names.end(), name);
        return column == names.end() ? "missing" : values.at(static_cast<std::size_t>(column - names.begin()));
    };
    EXPECT_EQ(value("channel"), "hall, \"east\"");
    EXPECT_EQ(value("frame"), "3");
    EXPECT_EQ(value("client"), "7");
    EXPECT_EQ(value("outcome"), "shown");
    EXPECT_EQ(value("pose_sampled_ns"), "1030000000");
    EXPECT_EQ(value("shown_ns"), "1063000000");
    EXPECT_EQ(value("rendered_ns"), "") << "unknown";
    EXPECT_EQ(value("stages"), "trace=2.5000;denoise=1.2500");
}

TEST_F(Timing, EveryJsonLineIsAnObject) {
    const auto file = folder_ / "frames.jsonl";
    {
        TimingRecorder recorder({.frame_log = file, .trace = {}});
        for (std::uint64_t id = 1; id <= 3; ++id) {
            recorder.add(frame_at(id));
        }
    }
    const auto lines = lines_of(file);
    ASSERT_EQ(lines.size(), 3U);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto row = nlohmann::json::parse(lines[i]);
        EXPECT_EQ(row["frame"], i + 1);
        EXPECT_EQ(row["decoded_ns"].get<std::int64_t>() - row["last_byte_ns"].get<std::int64_t>(), 1'000'000);
        EXPECT_TRUE(row["rendered_ns"].is_null());
        EXPECT_EQ(row["stages"]["denoise"], 1.25);
    }
}

TEST_F(Timing, TraceHasATrackPerStageAndSpansOfEveryClientThatClose) {
    const auto file = folder_ / "trace.json";
    {
        TimingRecorder recorder({.frame_log = {}, .trace = file});
        for (std::uint64_t id = 1; id <= 2; ++id) {
            recorder.add(frame_at(id).made);
            recorder.add(frame_at(id));
        }
    }
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    const auto events = nlohmann::json::parse(text.str());
    std::map<std::string, int> tracks;
    std::map<std::string, int> open;
    std::map<std::string, int> slices;
    for (const auto& event : events) {
        const std::string kind = event["ph"];
        const std::string name = event["name"];
        if (kind == "M") {
            ++tracks[event["args"]["name"]];
        } else if (kind == "X") {
            ++slices[name];
            EXPECT_GE(event["dur"].get<double>(), 0.0);
        } else {
            open[event["id"].get<std::string>() + name] += kind == "b" ? 1 : -1;
            EXPECT_GE(event["pid"], 1000);
        }
    }
    for (const char* const track : {"channel hall, \"east\"", "render", "encode", "device: trace", "client 7"}) {
        EXPECT_EQ(tracks[track], 1) << track;
    }
    EXPECT_EQ(slices["render"], 2);
    EXPECT_EQ(slices["device: denoise"], 2);
    EXPECT_EQ(open.size(), 10U) << "wait, send, travel, decode, show of two frames";
    EXPECT_TRUE(std::ranges::all_of(open, [](const auto& span) { return span.second == 0; }));
}

TEST_F(Timing, StagesOnTheDeviceStandOneAfterTheOther) {
    const auto file = folder_ / "trace.json";
    { TimingRecorder({.frame_log = {}, .trace = file}).add(frame_at(0).made); }
    const auto events = nlohmann::json::parse(std::ifstream(file));
    const auto start = [&](const char* name) {
        const auto found = std::ranges::find_if(
            events, [&](const auto& event) { return event["ph"] == "X" && event["name"] == name; });
        return found == events.end() ? -1.0 : (*found)["ts"].template get<double>();
    };
    EXPECT_DOUBLE_EQ(start("device: trace"), 1'001'000.0); // microseconds: when rendering begins
    EXPECT_DOUBLE_EQ(start("device: denoise"), 1'003'500.0);
}

TEST_F(Timing, MemoryIsBounded) {
    constexpr std::size_t kTooMany = 4 * TimingRecorder::kMaxWaiting;
    const auto file = folder_ / "frames.jsonl";
    std::uint64_t lost = 0;
    {
        TimingRecorder recorder({.frame_log = file, .trace = {}});
        for (std::size_t id = 1; id <= kTooMany; ++id) {
            recorder.add(frame_at(id));
        }
        lost = recorder.lost_count();
    }
    EXPECT_EQ(lines_of(file).size() + lost, kTooMany) << "written or counted as lost";
}

TEST_F(Timing, NamesSayTheForm) {
    const auto problem = [](const char* log, const char* trace) {
        return problem_with({.frame_log = log, .trace = trace}, "--frame-log", "--trace").value_or("");
    };
    EXPECT_EQ(problem("a.csv", "b.json"), "");
    EXPECT_EQ(problem("a.jsonl", ""), "");
    EXPECT_THAT(problem("a.txt", ""), HasSubstr("--frame-log a.txt"));
    EXPECT_THAT(problem("", "b.csv"), HasSubstr("--trace b.csv"));
}

TEST_F(Timing, AFileThatCannotBeCreatedIsTheUsersProblem) {
    EXPECT_THROW(TimingRecorder({.frame_log = folder_ / "no" / "such.csv", .trace = {}}), UserError);
}

TEST_F(Timing, OtherClocksAreMappedAndLiesAreUnknown) {
    EXPECT_EQ(on_our_clock(100, -30), 70);
    EXPECT_EQ(on_our_clock(0, 50), 0) << "unknown stays unknown";
    EXPECT_EQ(on_our_clock(INT64_MAX, 1), 0);
    EXPECT_EQ(on_our_clock(5, INT64_MIN), 0);
    EXPECT_EQ(on_our_clock(5, -10), 0) << "before the clock began";
}

} // namespace
} // namespace fieldcast::timing
