// SPDX-License-Identifier: Apache-2.0
// Changes on a running stream, with both programs. Every frame of the server is the same here (--clock frames --frames
// 1: the first frame again and again), so the picture of a new epoch must be the one that a fresh client with that
// configuration gets, to the last bit: the files are compared byte by byte.
#include "running_server.h"
#include "tests/fixtures/polling.h"
#include "tests/fixtures/test_folder.h"

#include <csignal>
#include <fstream>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr auto kPatience = 240s; // two cores, busy, software Vulkan, cold pipeline cache

/// Frames that a change may cost: one being rendered, one being encoded, one waiting and one being sent for the old
/// request.
constexpr int kFramesPerChange = 4;

class Changes : public testing::Test {
protected:
    void SetUp() override {
        if (server_.lacks_device()) {
            GTEST_SKIP() << server_.log();
        }
    }

    std::unique_ptr<Program> client(const std::string& name, std::vector<std::string> arguments) {
        const std::vector<std::string> all{"--server", "127.0.0.1:" + std::to_string(server_.port()),
                                           "--out",    folder_ / name,
                                           "--json",   folder_ / (name + ".json"),
                                           "--cache",  folder_ / "cache",
                                           "--write",  "quilt"};
        arguments.insert(arguments.begin(), all.begin(), all.end());
        return std::make_unique<Program>(FIELDCAST_CLIENT, arguments, folder_ / (name + ".log"));
    }

    void run(const std::string& name, const std::vector<std::string>& arguments) {
        const auto program = client(name, arguments);
        EXPECT_EQ(program->exit_code(kPatience), 0) << program->text();
    }

    nlohmann::json statistics(const std::string& name) {
        return nlohmann::json::parse(text_of(folder_ / (name + ".json")));
    }

    /// The one quilt in a folder: name and content.
    static std::pair<std::string, std::string> quilt_in(const fs::path& folder) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            if (entry.path().filename().string().starts_with("quilt_")) {
                return {entry.path().filename(), text_of(entry.path())};
            }
        }
        return {};
    }

    TestFolder folder_;
    RunningServer server_{
        FIELDCAST_SERVER,
        {"--frames", "1", "--frame-log", folder_ / "frames.jsonl", "--trace", folder_ / "trace.json"}};
};

TEST_F(Changes, PicturesAreThoseOfAFreshClientAndNothingIsLostBesides) {
    run("fresh_small", {"--grid", "3x3", "--frames", "1"});
    run("fresh_large", {"--grid", "5x5", "--frames", "1"});
    run("fresh_scene", {"--grid", "4x4", "--frames", "1", "--mode", "scene"});
    run("changing", {"--grid", "3x3", "--frames", "6", "--save", "all", "--change", "2f:grid=5x5", "--change",
                     "4f:grid=4x4,mode=scene"});
    std::map<std::string, std::string> fresh;
    for (const char* const name : {"fresh_small", "fresh_large", "fresh_scene"}) {
        fresh.insert(quilt_in(folder_ / name));
    }
    ASSERT_EQ(fresh.size(), 3U) << "grids differ, and so do the names";
    std::set<std::string> seen;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "changing")) {
        const auto [name, content] = quilt_in(entry.path());
        EXPECT_EQ(content, fresh[name]) << entry.path() << " " << name << " differs from a fresh client's";
        seen.insert(name);
    }
    EXPECT_EQ(seen.size(), 3U) << "frames of all three configurations were shown";

    const auto json = statistics("changing");
    EXPECT_EQ(json["sessions"], 1);
    EXPECT_EQ(json["changes"], 2);
    EXPECT_EQ(json["failed"], 0);
    const auto& epochs = json["epochs"];
    ASSERT_EQ(epochs.size(), 3U) << json.dump(2);
    EXPECT_EQ(epochs[1]["grid"], "5x5");
    EXPECT_EQ(epochs[2]["mode"], "scene, g-buffer");
    const double dropped =
        server_.metric("fieldcast_frames_dropped_total{channel=\"atelier\",reason=\"reconfigured\"}");
    EXPECT_GE(dropped, 0.0) << server_.metrics();
    EXPECT_LE(dropped, 2 * kFramesPerChange);
}

TEST_F(Changes, NestedGridsAreRenderedAndEncodedOnce) {
    const auto small = client("small", {"--grid", "3x3", "--frames", "0", "--save", "none"});
    const auto large = client("large", {"--grid", "6x6", "--frames", "0", "--save", "none"});
    ASSERT_TRUE(server_.shows("fieldcast_sessions{channel=\"atelier\",mode=\"views\",grid=\"3x3\"}", 1.0, kPatience));
    ASSERT_TRUE(server_.shows("fieldcast_sessions{channel=\"atelier\",mode=\"views\",grid=\"6x6\"}", 1.0, kPatience));
    const auto frames = [&] { return server_.metric("fieldcast_frames_rendered_total{channel=\"atelier\"}"); };
    const double frames_before = frames();
    EXPECT_TRUE(comes_true([&] { return frames() >= frames_before + 4; }, kPatience)) << server_.log();
    // Frames with both clients have 45 views asked for and 36 made; those before, with one of them, share nothing.
    const std::string page = server_.metrics(); // one moment: frames go on
    const auto views = [&](const char* step) {
        return RunningServer::value_on(page, "fieldcast_views_total{channel=\"atelier\",step=\"" +
                                                 std::string(step) + "\"}");
    };
    const double asked = views("asked");
    const double rendered = views("rendered");
    EXPECT_GE(asked - rendered, 2 * 9.0) << "nine views per frame are shared\n" << page;
    EXPECT_EQ(static_cast<int>(asked - rendered) % 9, 0);
    EXPECT_LE(rendered - views("encoded"), 36.0) << "all but the frame under way is encoded, each view once";
    for (Program* const program : {small.get(), large.get()}) {
        program->send_signal(SIGINT);
        EXPECT_EQ(program->exit_code(kPatience), 130) << program->text();
    }
    server_.process().send_signal(SIGINT);
    EXPECT_EQ(server_.process().exit_code(kPatience), 0);

    // The files are complete after Ctrl-C.
    const auto events = nlohmann::json::parse(text_of(folder_ / "trace.json"));
    EXPECT_GT(events.size(), 100U);
    std::istringstream rows(text_of(folder_ / "frames.jsonl"));
    std::set<int> clients;
    int shown = 0;
    for (std::string line; std::getline(rows, line);) {
        const auto row = nlohmann::json::parse(line);
        clients.insert(row["client"].get<int>());
        shown += row["outcome"] == "shown" ? 1 : 0;
        if (row["outcome"] == "shown" && !row["shown_ns"].is_null()) {
            EXPECT_LT(row["pose_sampled_ns"].get<std::int64_t>(), row["render_end_ns"].get<std::int64_t>());
            EXPECT_LE(row["render_end_ns"].get<std::int64_t>(), row["send_begin_ns"].get<std::int64_t>());
            EXPECT_LT(row["pose_sampled_ns"].get<std::int64_t>(), row["shown_ns"].get<std::int64_t>());
        }
    }
    EXPECT_EQ(clients.size(), 2U);
    EXPECT_GE(shown, 4);
}

} // namespace
} // namespace fieldcast::test
