// SPDX-License-Identifier: Apache-2.0
// Steering from the command line: where poses come from, and what a run sends, against a server that follows a script.
#include "client/play/live_poses.h"
#include "client/play/playback.h"
#include "tests/client/fake_server.h"
#include "tests/fixtures/polling.h"
#include "tests/fixtures/test_folder.h"

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <unistd.h>

namespace fieldcast::test {
namespace {

using namespace client;
using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr float kRounding = 1e-5F; // a few roundings of floats below 10

glm::vec3 position_of(const std::optional<net::WantedPose>& pose) {
    return glm::vec3(pose.value().world_from_camera[3]);
}

void expect_near(const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LT(glm::length(a - b), kRounding) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(CameraPath, OrbitsAroundWhatTheCameraLooksAt) {
    const glm::mat4 start = glm::translate(glm::mat4(1.0F), glm::vec3(1.0F, 2.0F, 3.0F)); // looks along -Z
    const play::PoseSource orbit = play::read_camera_path("orbit:radius=2,seconds=8");
    expect_near(position_of(orbit(0.0, start)), {1.0F, 2.0F, 3.0F});
    const auto quarter = orbit(2.0, start);
    expect_near(position_of(quarter), {3.0F, 2.0F, 1.0F}); // around (1, 2, 1)
    expect_near(glm::vec3(quarter->world_from_camera[2]), {1.0F, 0.0F, 0.0F}); // and looks along -X
    expect_near(position_of(orbit(8.0, start)), {1.0F, 2.0F, 3.0F});
}

TEST(CameraPath, FilesAreInterpolated) {
    const TestFolder folder;
    write_file(folder / "path.json", R"([{"time_s": 1, "position": [0, 0, 4], "look_at": [0, 0, 0]},
                                         {"time_s": 3, "position": [4, 0, 0], "look_at": [0, 0, 0]},
                                         {"time_s": 4, "position": [0, 9, 9], "look_at": [0, 0, 0], "cut": true}])");
    const play::PoseSource path = play::read_camera_path((folder / "path.json").string());
    expect_near(position_of(path(0.0, {})), {0.0F, 0.0F, 4.0F});
    const auto middle = path(2.0, {});
    expect_near(position_of(middle), {2.0F, 0.0F, 2.0F});
    expect_near(glm::vec3(middle->world_from_camera[2]), glm::normalize(glm::vec3(1.0F, 0.0F, 1.0F)));
    expect_near(position_of(path(3.9, {})), {4.0F, 0.0F, 0.0F}); // nothing leads to a jump
    const auto jump = path(4.5, {});
    EXPECT_TRUE(jump->cut);
    expect_near(position_of(jump), {0.0F, 9.0F, 9.0F});
    EXPECT_FALSE(path(5.0, {})->cut) << "said once";
}

TEST(CameraPath, ProblemsNameThePlace) {
    const TestFolder folder;
    const auto problem = [&](const std::string& content) {
        write_file(folder / "path.json", content);
        try {
            play::read_camera_path((folder / "path.json").string());
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(problem("[]"), HasSubstr("path.json"));
    EXPECT_THAT(problem("[{}]"), HasSubstr("pose 0: needs position"));
    EXPECT_THAT(problem(R"([{"position": [0, 0, 1], "look_at": [0, 0, 0]}])"), HasSubstr("time_s"));
    EXPECT_THAT(problem(R"([{"time_s": 0, "position": [0, 1, 0], "look_at": [0, 0, 0]}])"), HasSubstr("straight"));
    EXPECT_THAT(problem(R"([{"time_s": 0, "world_from_camera": [1, 0, 0]}])"), HasSubstr("12 numbers"));
    EXPECT_THAT(problem(R"([{"time_s": 0, "position": [1e99, 0, 0], "look_at": [0, 0, 0]}])"), HasSubstr("finite"));
    for (const char* const orbit : {"orbit:radius=0", "orbit:radius=two", "orbit:seconds=-1", "orbit:radius=2x"}) {
        EXPECT_THROW(play::read_camera_path(orbit), UserError) << orbit;
    }
    EXPECT_THROW(play::read_camera_path("/no/such/path.json"), UserError);
}

TEST(LivePoses, TheNewestLineWins) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    play::LivePoses poses(pipe[0]);
    const std::string lines = "no pose\n" R"({"position": [0, 0, 1], "look_at": [0, 0, 0], "cut": true})" "\n"
                              R"({"position": [0, 0, 2], "look_at": [0, 0, 0]})" "\n";
    ASSERT_EQ(::write(pipe[1], lines.data(), lines.size()), static_cast<ssize_t>(lines.size()));
    std::optional<net::WantedPose> newest;
    bool was_cut = false;
    const auto last_has_come = [&] { // the lines arrive together or one after the other
        if (const auto pose = poses.take()) {
            newest = pose;
            was_cut = was_cut || pose->cut;
        }
        return newest && position_of(newest).z >= 2.0F;
    };
    EXPECT_TRUE(comes_true(last_has_come, 20s));
    expect_near(position_of(newest), {0.0F, 0.0F, 2.0F});
    EXPECT_TRUE(was_cut) << "a jump is not lost with its pose";
    EXPECT_FALSE(poses.take().has_value());
    ::close(pipe[1]);
    ::close(pipe[0]);
}

class SteeredPlay : public testing::Test {
protected:
    play::PlayOptions options(const FakeServer& server, const std::string& path) const {
        play::PlayOptions options;
        options.server = {.address = server.address(), .reconnects = false, .patience = 10'000ms};
        options.request.rows = options.request.cols = 1;
        options.save = play::Save::kNone;
        options.steering = {.poses = play::read_camera_path(path), .waits = false};
        return options;
    }

    static v1::ServerMessage granted() {
        v1::ServerMessage message;
        message.mutable_steering_granted()->set_lease(4);
        message.mutable_steering_granted()->set_expires_after_ms(5000);
        return message;
    }

    /// Frame `id`; shows that pose if there is one.
    static void send_frame(FakeCall& call, const wire::ViewSet& set, std::uint64_t id, const v1::SteerCamera* pose) {
        auto messages = views_messages(set, id);
        if (pose != nullptr) {
            v1::AppliedPose& applied =
                *messages.front().mutable_frame_chunk()->mutable_header()->mutable_applied_pose();
            applied.set_lease(4);
            applied.set_sequence(pose->sequence());
            applied.set_client_time_ns(pose->client_time_ns());
        }
        call.send(messages);
        auto ack = call.read_until(v1::ClientMessage::kFrameAck);
        while (ack && ack->frame_ack().shown_ns() == 0) { // so that no frame supersedes it
            ack = call.read_until(v1::ClientMessage::kFrameAck);
        }
    }
};

TEST_F(SteeredPlay, AsksSendsPosesAndMeasuresMotionToPhoton) {
    std::vector<v1::SteerCamera> poses;
    bool asked_to_wait = true;
    const FakeServer server([&](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        const auto request = call.read_until(v1::ClientMessage::kRequestSteering);
        asked_to_wait = request.value().request_steering().waits();
        call.send(granted());
        send_frame(call, set, 1, nullptr);
        for (std::uint64_t id = 2; id <= 4; ++id) {
            const auto message = call.read_until(v1::ClientMessage::kSteerCamera);
            poses.push_back(message.value().steer_camera());
            send_frame(call, set, id, &poses.back());
        }
        send_frame(call, set, 5, &poses.back()); // the same pose again
        call.read_rest();
    });
    play::PlayOptions wanted = options(server, "orbit:radius=2,seconds=8");
    wanted.frames = 5;
    const play::PlayResult result = play::play(wanted, [](const play::Progress&) {}, {});
    EXPECT_FALSE(result.failure);
    EXPECT_FALSE(asked_to_wait);
    ASSERT_EQ(poses.size(), 3U);
    EXPECT_EQ(poses[0].world_from_camera_size(), 12);
    EXPECT_LT(poses[0].sequence(), poses[1].sequence());
    EXPECT_LT(poses[1].client_time_ns(), poses[2].client_time_ns());
    EXPECT_EQ(result.summary.poses_shown, 3U) << "the first frame shows none, the last one nothing new";
    ASSERT_TRUE(result.summary.motion_to_photon_ms.has_value());
    EXPECT_GT(result.summary.motion_to_photon_ms->p50, 0.0);
    EXPECT_LT(result.summary.motion_to_photon_ms->p95, 20'000.0) << "as long as the whole test may take";
    EXPECT_THAT(to_table(result.summary), HasSubstr("motion to photon"));
    EXPECT_THAT(to_json(result.summary), HasSubstr("\"poses_shown\": 3"));
}

TEST_F(SteeredPlay, ARefusalEndsTheRunAndSaysWhy) {
    const FakeServer server([&](FakeCall& call, int) {
        call.grant();
        call.read_until(v1::ClientMessage::kRequestSteering);
        v1::ServerMessage message;
        message.mutable_steering_denied()->set_reason(v1::STEERING_DENIAL_REASON_HELD);
        message.mutable_steering_denied()->set_message("the camera is steered by ann");
        call.send(message);
        call.read_rest();
    });
    const play::PlayResult result = play::play(options(server, "orbit"), [](const play::Progress&) {}, {});
    ASSERT_TRUE(result.failure.has_value());
    EXPECT_TRUE(result.failure->was_refused);
    EXPECT_THAT(result.failure->message, HasSubstr("ann"));
}

TEST_F(SteeredPlay, AsksAgainAfterALeaseThatExpired) {
    bool asked_to_wait = false;
    const FakeServer server([&](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        call.read_until(v1::ClientMessage::kRequestSteering);
        v1::ServerMessage message;
        message.mutable_steering_released()->set_reason(v1::STEERING_RELEASE_REASON_EXPIRED);
        call.send(granted());
        call.send(message);
        const auto again = call.read_until(v1::ClientMessage::kRequestSteering);
        asked_to_wait = again.has_value() && again->request_steering().waits();
        send_frame(call, set, 1, nullptr);
        call.read_rest();
    });
    play::PlayOptions wanted = options(server, "orbit");
    wanted.frames = 1;
    EXPECT_FALSE(play::play(wanted, [](const play::Progress&) {}, {}).failure);
    EXPECT_TRUE(asked_to_wait);
}

} // namespace
} // namespace fieldcast::test
