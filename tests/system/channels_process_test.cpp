// SPDX-License-Identifier: Apache-2.0
// Both programs with a camera that a client steers, and with two channels that share the device.
#include "core/base/guarded.h"
#include "running_server.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/server_client.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = 120s; // a software device on a busy machine
constexpr auto kSharingPatience = 400s; // there a dozen frames of two channels took seconds each
constexpr const char* kScene = "scenes/atelier/atelier.gltf";

class SteeredChannel : public testing::Test {
protected:
    void SetUp() override {
        if (server_.lacks_device()) {
            GTEST_SKIP() << server_.log();
        }
    }

    std::vector<std::string> flags(const std::string& frames) const {
        return {"--server", "127.0.0.1:" + std::to_string(server_.port()), "--grid", "1x1", "--save", "none",
                "--frames", frames, "--verbose", "--steer", "orbit:radius=1,seconds=30"};
    }

    const TestFolder folder_;
    RunningServer server_{FIELDCAST_SERVER, {"--camera-control", "steered"}};
};

TEST_F(SteeredChannel, TheClientDrivesItAndMeasuresMotionToPhoton) {
    std::vector<std::string> arguments = flags("12");
    arguments.insert(arguments.end(), {"--json", (folder_ / "result.json").string()});
    Program client(FIELDCAST_CLIENT, arguments, folder_ / "client.txt");
    ASSERT_EQ(client.exit_code(kPatience), 0) << client.text();
    EXPECT_THAT(client.text(), HasSubstr("motion to photon"));
    const auto result = nlohmann::json::parse(text_of(folder_ / "result.json"));
    EXPECT_GE(result["poses_shown"], 3) << "of 12 frames; the first ones came before the first pose";
    EXPECT_GT(result["motion_to_photon_ms"]["p50"], 0.0);
    EXPECT_LT(result["motion_to_photon_ms"]["p95"], 60'000.0) << "both times are of one clock";
}

TEST_F(SteeredChannel, ASecondOneIsToldWhoSteers) {
    Program first(FIELDCAST_CLIENT, flags("0"), folder_ / "first.txt");
    ASSERT_TRUE(first.has_said("we steer", kPatience)) << first.text();
    std::vector<std::string> arguments = flags("1000");
    arguments.emplace_back("--steer-now");
    Program second(FIELDCAST_CLIENT, arguments, folder_ / "second.txt");
    EXPECT_EQ(second.exit_code(kPatience), 2) << second.text();
    EXPECT_THAT(second.text(), HasSubstr("the camera is steered by session"));
    Program third(FIELDCAST_CLIENT, flags("0"), folder_ / "third.txt");
    ASSERT_TRUE(third.has_said("waiting for the camera", kPatience)) << third.text();
    first.send_signal(SIGINT);
    EXPECT_TRUE(third.has_said("we steer", kPatience)) << third.text();
}

/// Keeps getting frames of a channel, with all their views, as fast as they come.
class Watcher {
public:
    Watcher(int port, const std::string& channel, std::uint32_t side)
        : thread_([=, this](const std::stop_token& stop) {
              v1::Configure wanted;
              wanted.set_channel(channel);
              wanted.mutable_grid()->set_rows(side);
              wanted.mutable_grid()->set_cols(side);
              watch(port, wanted, stop);
          }) {}

    /// Waits until it has got so many frames in total.
    bool gets(int count) {
        return frames_.lock().wait_until(came_, Clock::now() + kSharingPatience,
                                         [=](int frames) { return frames >= count; });
    }

private:
    void watch(int port, const v1::Configure& wanted, const std::stop_token& stop) {
        OpenCall call(connect(port), "", kSharingPatience);
        call.configure(wanted);
        for (auto trailer = call.read_frame(); trailer && !stop.stop_requested(); trailer = call.read_frame()) {
            call.acknowledge(*trailer);
            ++*frames_.lock();
            came_.notify_all();
        }
        call.half_close();
        call.finish();
    }

    std::condition_variable came_;
    Guarded<int> frames_;
    std::jthread thread_;
};

struct Usage {
    double seconds = 0.0;
    double frames = 0.0;
};

TEST(SharedDevice, AnExpensiveChannelGetsNoMoreOfItThanACheapOne) {
    const RunningServer server(FIELDCAST_SERVER,
                               {"--channel", std::string("cheap=") + kScene, "--fps", "240", "--guard-band", "none"});
    if (server.lacks_device()) {
        GTEST_SKIP() << server.log();
    }
    const auto usage = [](const std::string& page, const std::string& channel) {
        const std::string labels = "{channel=\"" + channel + "\"}";
        return Usage{RunningServer::value_on(page, "fieldcast_device_seconds_sum" + labels),
                     RunningServer::value_on(page, "fieldcast_device_seconds_count" + labels)};
    };
    Watcher expensive(server.port(), "atelier", 6);
    const Watcher cheap(server.port(), "cheap", 1);
    ASSERT_TRUE(expensive.gets(3)) << "both run\n" << server.log();
    const std::string before = server.metrics(); // what both have had until one moment
    ASSERT_TRUE(expensive.gets(11)) << server.log();
    const std::string after = server.metrics();
    const double a = usage(after, "atelier").seconds - usage(before, "atelier").seconds;
    const double b = usage(after, "cheap").seconds - usage(before, "cheap").seconds;
    const double cost_a = a / (usage(after, "atelier").frames - usage(before, "atelier").frames);
    const double cost_b = b / (usage(after, "cheap").frames - usage(before, "cheap").frames);
    const double jain = (a + b) * (a + b) / (2.0 * (a * a + b * b));
    RecordProperty("jain", std::to_string(jain));
    std::printf("expensive %.3f s, %.1f ms a frame; cheap %.3f s, %.1f ms a frame; Jain %.4f\n", a, cost_a * 1e3, b,
                cost_b * 1e3, jain);
    ASSERT_GT(cost_a, 1.5 * cost_b) << "otherwise nothing is tested";
    // Turns one after the other would give (r + 1)^2 / (2 (r^2 + 1)) for costs in the ratio r: 0.96 for 1.5, 0.74
    // for 4. Here two frames of eight may be on the wrong side of the two moments: 14^2 / (2 (8^2 + 6^2)) = 0.98.
    EXPECT_GT(jain, 0.97);
}

} // namespace
} // namespace fieldcast::test
