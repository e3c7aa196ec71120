// SPDX-License-Identifier: Apache-2.0
// The server as a process: exit codes, port file, first frames of a rendered scene, signals.
#include "core/wire/frame_assembler.h"
#include "tests/fixtures/program.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/server_client.h"

#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>

namespace fieldcast::test {
namespace {

constexpr const char* kScene = "scenes/atelier/atelier.gltf";
constexpr std::chrono::seconds kPatience{240}; // a software device under sanitizers on a busy machine

class ServerProcess : public testing::Test {
protected:
    Program start(const std::vector<std::string>& arguments) {
        return Program(FIELDCAST_SERVER, arguments, folder_ / "output.txt");
    }

    const TestFolder folder_;
};

TEST_F(ServerProcess, HelpIsNoError) {
    Program server = start({"--help"});
    EXPECT_EQ(server.exit_code(kPatience), 0);
    EXPECT_NE(server.text().find("Examples:"), std::string::npos);
}

TEST_F(ServerProcess, WrongFlagsExitWithTwo) {
    Program server = start({"--scene", "/no/such.gltf", "--listen", "0.0.0.0:1"});
    EXPECT_EQ(server.exit_code(kPatience), 2);
    EXPECT_NE(server.text().find("no such file"), std::string::npos);
    EXPECT_NE(server.text().find("loopback"), std::string::npos);
}

TEST_F(ServerProcess, ChecksAConfiguration) {
    Program server = start({"--scene", kScene, "--check-config"});
    EXPECT_EQ(server.exit_code(kPatience), 0) << server.text();
}

TEST_F(ServerProcess, WrongConfigurationExitsWithTwoAndNamesThePlace) {
    const std::string file = folder_ / "server.toml";
    write_file(file, "scene = \"" + std::string(kScene) + "\"\n\nspp = 0\n");
    Program server = start({"--config", file, "--check-config"});
    EXPECT_EQ(server.exit_code(kPatience), 2);
    EXPECT_NE(server.text().find(file + ":3: spp 0"), std::string::npos) << server.text();
}

/// A server that renders small images of the demo scene.
class RenderingServer : public testing::Test {
protected:
    explicit RenderingServer(const std::vector<std::string>& more_flags = {})
        : server_(FIELDCAST_SERVER, flags(more_flags), folder_ / "server.log") {}

    void SetUp() override {
        if (!server_.has_said("SERVING", kPatience)) {
            ASSERT_NE(server_.text().find("Vulkan d"), std::string::npos) << server_.text();
            GTEST_SKIP() << server_.text();
        }
        port_ = std::stoi(text_of(port_file_));
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

    std::vector<std::string> flags(const std::vector<std::string>& more) const {
        std::vector<std::string> flags{"--scene", kScene, "--size", "64x36", "--listen", "127.0.0.1:0",
                                       "--port-file", port_file_};
        flags.insert(flags.end(), more.begin(), more.end());
        return flags;
    }

    const TestFolder folder_;
    const std::filesystem::path port_file_ = folder_ / "port";
    Program server_;
    int port_ = 0;
};

class LoopingServer : public RenderingServer {
protected:
    LoopingServer() : RenderingServer({"--clock", "frames", "--frames", "3"}) {}
};

TEST_F(LoopingServer, SendsBothModesAndDrains) {
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
    server_.send_signal(SIGTERM);
    for (OpenCall* const call : {&thin, &thick}) {
        EXPECT_TRUE(call->read_until(v1::ServerMessage::kGoingAway).has_value());
        call->half_close();
        EXPECT_TRUE(call->finish().ok());
    }
    EXPECT_EQ(server_.exit_code(kPatience), 0) << server_.text();
    EXPECT_FALSE(std::filesystem::exists(port_file_));
}

TEST_F(LoopingServer, SecondSignalStopsAtOnce) {
    OpenCall call(connect(port_));
    call.configure();
    headers(call, 1);
    server_.send_signal(SIGTERM);
    EXPECT_TRUE(call.read_until(v1::ServerMessage::kGoingAway).has_value());
    server_.send_signal(SIGTERM);
    EXPECT_EQ(server_.exit_code(kPatience), 0) << server_.text();
    EXPECT_FALSE(call.finish().ok());
}

/// The scene rests, so whatever changes by more than noise is the camera's doing.
class SteeredServer : public RenderingServer {
protected:
    SteeredServer() : RenderingServer({"--camera-control", "steered", "--time", "0"}) {}

    /// The next frame, one view of the source; acknowledged.
    wire::ReceivedFrame frame(OpenCall& call) {
        while (auto message = call.read_until(v1::ServerMessage::kFrameChunk)) {
            const v1::FrameChunk chunk = message->frame_chunk();
            auto added = assembler_.add(std::move(*message->mutable_frame_chunk()));
            EXPECT_TRUE(added.has_value());
            if (chunk.has_trailer()) {
                call.acknowledge(chunk);
            }
            if (added && *added) {
                return std::move(**added);
            }
        }
        throw std::runtime_error("the stream ended\n" + server_.text());
    }

    /// The first frame that shows the pose of that number.
    wire::ReceivedFrame frame_of(OpenCall& call, std::uint64_t sequence) {
        wire::ReceivedFrame received = frame(call);
        while (received.header().applied_pose.value_or(AppliedPose{}).sequence != sequence) {
            received = frame(call);
        }
        return received;
    }

    static void steer(OpenCall& call, const glm::mat4& pose, std::uint64_t sequence, bool cut = false) {
        v1::ClientMessage message;
        v1::SteerCamera& steer = *message.mutable_steer_camera();
        for (int i = 0; i < 12; ++i) {
            steer.add_world_from_camera(pose[i / 3][i % 3]);
        }
        steer.set_sequence(sequence);
        steer.set_client_time_ns(static_cast<std::int64_t>(1000 + sequence));
        steer.set_cut(cut);
        call.send(message);
    }

    /// Mean difference of two pictures of equal size, in steps of 8 bits.
    static double difference(const wire::ReceivedFrame& a, const wire::ReceivedFrame& b) {
        const auto& left = std::get<wire::ReceivedViews>(a.content).views.views.at(0).image.bytes;
        const auto& right = std::get<wire::ReceivedViews>(b.content).views.views.at(0).image.bytes;
        double sum = 0.0;
        for (std::size_t i = 0; i < left.size(); ++i) {
            sum += std::abs(std::to_integer<int>(left[i]) - std::to_integer<int>(right.at(i)));
        }
        return sum / static_cast<double>(left.size());
    }

    wire::FrameAssembler assembler_;
};

TEST_F(SteeredServer, PosesMoveTheCameraAndThePicture) {
    OpenCall call(connect(port_), "", kPatience); // some twenty frames
    v1::Configure wanted;
    wanted.mutable_grid()->set_rows(1);
    wanted.mutable_grid()->set_cols(1);
    call.configure(wanted);
    const auto configured = call.read_until(v1::ServerMessage::kConfigured);
    ASSERT_TRUE(configured.has_value());
    assembler_.begin_epoch(configured->configured().epoch(), {});
    wire::ReceivedFrame rest = frame(call);
    for (int i = 0; i < 3; ++i) {
        rest = frame(call); // noise settles
    }
    EXPECT_FALSE(rest.header().applied_pose.has_value());
    const glm::mat4 start = rest.header().source.world_from_camera;
    v1::ClientMessage request;
    request.mutable_request_steering();
    call.send(request);

    steer(call, start, 1);
    const wire::ReceivedFrame same = frame_of(call, 1);
    EXPECT_EQ(same.header().applied_pose, (AppliedPose{.lease = 1, .sequence = 1, .client_time_ns = 1001}));
    const double noise = difference(rest, same);

    const glm::mat4 turned = start * glm::mat4(glm::mat3(glm::vec3(0, 0, -1), glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)));
    steer(call, turned, 2);
    const wire::ReceivedFrame moved = frame_of(call, 2);
    EXPECT_FALSE(moved.header().cut);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) { // a few roundings of floats below 10
            EXPECT_NEAR(moved.header().source.world_from_camera[column][row], turned[column][row], 1e-5F);
        }
    }
    EXPECT_GT(difference(rest, moved), 5.0 * noise + 5.0) << "a quarter turn shows another picture";

    steer(call, start, 3, true);
    const wire::ReceivedFrame back = frame_of(call, 3);
    EXPECT_TRUE(back.header().cut);
    EXPECT_LT(difference(rest, back), difference(rest, moved) / 2.0) << "the old picture again, but for noise";
    EXPECT_FALSE(frame(call).header().cut) << "one jump is one cut";
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST_F(ServerProcess, RenderWritesALightFieldWithoutServing) {
    const std::filesystem::path field = folder_ / "field";
    Program process = start({"render", "--scene", kScene, "--size", "64x36", "--largest-grid", "2x3", "--sources",
                             "diagonal", "--count", "2", "--every-frame", "--out", field});
    EXPECT_EQ(process.exit_code(kPatience), 0) << process.text();
    for (const char* frame : {"frame_000000", "frame_000001"}) {
        EXPECT_TRUE(std::filesystem::exists(field / frame / "view_r1_c2.png")) << frame;
        EXPECT_TRUE(std::filesystem::exists(field / frame / "source.exr")) << frame;
    }
}

TEST_F(ServerProcess, ViewsThatTheDeviceCannotDenoiseEndTheStart) {
    Program process = start({"render", "--scene", kScene, "--denoise", "views", "--size", "8192x8192", "--largest-grid",
                             "8x9", "--count", "1"}); // 4.8 · 10⁹ pixels: more than a texel buffer can have
    EXPECT_EQ(process.exit_code(kPatience), 2);
    EXPECT_NE(process.text().find("72 views of 8192x8192 are too many for"), std::string::npos) << process.text();
}

} // namespace
} // namespace fieldcast::test
