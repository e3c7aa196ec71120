// SPDX-License-Identifier: Apache-2.0
// The server as a process: exit codes, port file, first frames of a rendered scene, signals.
#include "server_client.h"

#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char** environ;

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kScene = "scenes/atelier/atelier.gltf";
constexpr std::chrono::seconds kStartDeadline{240}; // a software device under sanitizers on a busy machine

/// A running fieldcast-server; killed when destroyed.
class Process {
public:
    explicit Process(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), FIELDCAST_SERVER);
        std::vector<char*> pointers;
        for (std::string& argument : arguments) {
            pointers.push_back(argument.data());
        }
        pointers.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, 1, output().c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
        posix_spawn_file_actions_adddup2(&actions, 1, 2);
        EXPECT_EQ(posix_spawn(&pid_, FIELDCAST_SERVER, &actions, nullptr, pointers.data(), environ), 0);
        posix_spawn_file_actions_destroy(&actions);
    }

    ~Process() {
        if (!exit_code_) {
            kill(pid_, SIGKILL);
            wait();
        }
        std::filesystem::remove(output());
    }

    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void terminate() const { kill(pid_, SIGTERM); }

    bool has_ended() {
        int status = 0;
        if (!exit_code_ && waitpid(pid_, &status, WNOHANG) == pid_) {
            exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        }
        return exit_code_.has_value();
    }

    /// Exit code, 128 + signal if it was killed.
    int wait() {
        int status = 0;
        if (!exit_code_ && waitpid(pid_, &status, 0) == pid_) {
            exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        }
        return exit_code_.value_or(-1);
    }

    std::string text() const {
        std::ostringstream text;
        text << std::ifstream(output()).rdbuf();
        return text.str();
    }

private:
    std::string output() const { return testing::TempDir() + "server_process_" + std::to_string(getpid()) + ".log"; }

    pid_t pid_ = -1;
    std::optional<int> exit_code_;
};

TEST(ServerProcess, HelpIsNoError) {
    Process server({"--help"});
    EXPECT_EQ(server.wait(), 0);
    EXPECT_NE(server.text().find("Examples:"), std::string::npos);
}

TEST(ServerProcess, WrongFlagsExitWithTwo) {
    Process server({"--scene", "/no/such.gltf", "--listen", "0.0.0.0:1"});
    EXPECT_EQ(server.wait(), 2);
    EXPECT_NE(server.text().find("no such file"), std::string::npos);
    EXPECT_NE(server.text().find("loopback"), std::string::npos);
}

TEST(ServerProcess, ChecksAConfiguration) {
    Process server({"--scene", kScene, "--check-config"});
    EXPECT_EQ(server.wait(), 0) << server.text();
}

TEST(ServerProcess, WrongConfigurationExitsWithTwoAndNamesThePlace) {
    const std::string file = testing::TempDir() + "server_process_" + std::to_string(getpid()) + ".toml";
    std::ofstream(file) << "scene = \"" << kScene << "\"\n\nspp = 0\n";
    Process server({"--config", file, "--check-config"});
    EXPECT_EQ(server.wait(), 2);
    EXPECT_NE(server.text().find(file + ":3: spp 0"), std::string::npos) << server.text();
    std::filesystem::remove(file);
}

/// A server that renders small images of the demo scene.
class RenderingServer : public testing::Test {
protected:
    void SetUp() override {
        while (!std::filesystem::exists(port_file_)) {
            if (server_.has_ended()) {
                ASSERT_NE(server_.text().find("Vulkan d"), std::string::npos) << server_.text();
                GTEST_SKIP() << server_.text();
            }
            ASSERT_LT(Clock::now(), deadline_) << server_.text();
            std::this_thread::sleep_for(20ms); // a file has no event to wait for
        }
        std::ifstream(port_file_) >> port_;
    }

    /// Headers of the next `count` frames, acknowledged.
    std::vector<v1::FrameHeader> headers(OpenCall& call, std::size_t count) {
        std::vector<v1::FrameHeader> headers;
        for (std::size_t complete = 0; complete < count;) {
            const auto message = call.read_until(v1::ServerMessage::kFrameChunk);
            if (!message) {
                ADD_FAILURE() << "the stream ended\n" << server_.text();
                break;
            }
            const v1::FrameChunk& chunk = message->frame_chunk();
            if (chunk.has_header()) {
                headers.push_back(chunk.header());
            } else if (chunk.has_trailer()) {
                call.acknowledge(chunk);
                ++complete;
            }
        }
        return headers;
    }

    const std::string port_file_ = testing::TempDir() + "server_port_" + std::to_string(getpid());
    const Clock::time_point deadline_ = Clock::now() + kStartDeadline;
    Process server_{{"--scene", kScene, "--size", "64x36", "--clock", "frames", "--frames", "3", "--listen",
                     "127.0.0.1:0", "--port-file", port_file_}};
    int port_ = 0;
};

TEST_F(RenderingServer, SendsBothModesAndDrains) {
    OpenCall thin(connect(port_));
    OpenCall thick(connect(port_));
    v1::Configure wanted;
    wanted.mutable_grid()->set_rows(3);
    wanted.mutable_grid()->set_cols(3);
    thin.configure(wanted);
    wanted.add_modes(v1::DELIVERY_MODE_SCENE);
    thick.configure(wanted);
    EXPECT_EQ(headers(thin, 2).at(1).views().view_set().grid().rows(), 3U);
    const auto planes = headers(thick, 2);
    EXPECT_EQ(planes.at(1).planes().planes_size(), 2);
    EXPECT_GT(planes.at(1).settings().exposure(), 0.0F);
    EXPECT_GT(planes.at(1).render_times_size(), 0);
    server_.terminate();
    for (OpenCall* const call : {&thin, &thick}) {
        EXPECT_TRUE(call->read_until(v1::ServerMessage::kGoingAway).has_value());
        call->half_close();
        EXPECT_TRUE(call->finish().ok());
    }
    EXPECT_EQ(server_.wait(), 0) << server_.text();
    EXPECT_FALSE(std::filesystem::exists(port_file_));
}

TEST_F(RenderingServer, SecondSignalStopsAtOnce) {
    OpenCall call(connect(port_));
    call.configure();
    headers(call, 1);
    server_.terminate();
    EXPECT_TRUE(call.read_until(v1::ServerMessage::kGoingAway).has_value());
    server_.terminate();
    EXPECT_EQ(server_.wait(), 0) << server_.text();
    EXPECT_FALSE(call.finish().ok());
}

TEST(ServerProcess, RenderWritesALightFieldWithoutServing) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "fieldcast_render_test";
    std::filesystem::remove_all(folder);
    Process process({"render", "--scene", kScene, "--size", "64x36", "--largest-grid", "2x3", "--sources", "diagonal",
                     "--count", "2", "--every-frame", "--out", folder.string()});
    EXPECT_EQ(process.wait(), 0);
    for (const char* frame : {"frame_000000", "frame_000001"}) {
        EXPECT_TRUE(std::filesystem::exists(folder / frame / "view_r1_c2.png")) << frame;
        EXPECT_TRUE(std::filesystem::exists(folder / frame / "source.exr")) << frame;
    }
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace fieldcast::test
