// SPDX-License-Identifier: Apache-2.0
// Whole runs, against a server that follows a script. Times are short, and bounds wide enough for a busy machine.
#include "client/load/load_run.h"
#include "run_until.h"
#include "tests/client/closed_port.h"
#include "tests/client/fake_server.h"
#include "tests/server/frame_time.h"

#include <gmock/gmock.h>

namespace fieldcast::client::load {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using test::FakeCall;
using test::FakeServer;
using testing::HasSubstr;

constexpr auto kFrameTime = 10ms; // of the scripted renderer

/// Frames until the client leaves; ids grow by `step`. `frames`: as many at most, then silence.
void stream(FakeCall& call, std::uint64_t step = 1, std::uint64_t frames = UINT64_MAX) {
    const wire::ViewSet set = call.grant();
    for (std::uint64_t i = 1; i <= frames; ++i) {
        call.send(test::views_messages(set, i * step));
        if (!call.read_until(v1::ClientMessage::kFrameAck)) {
            return;
        }
        test::pass_frame_time(kFrameTime);
    }
    call.read_rest();
}

Group group_of(const std::string& name, std::uint32_t count) {
    Group group;
    group.name = name;
    group.count = count;
    group.request.rows = 1;
    group.request.cols = 2;
    group.due_fps = 20.0;
    return group;
}

Scenario scenario_of(const FakeServer& server, std::vector<Group> groups) {
    Scenario scenario;
    scenario.address = server.address();
    scenario.groups = std::move(groups);
    scenario.threads = 2;
    return scenario;
}

LoadResult run(const FakeServer& server, std::vector<Group> groups, Seconds duration = 1s, Seconds ramp = 0s) {
    Scenario scenario = scenario_of(server, std::move(groups));
    scenario.duration = duration;
    scenario.ramp = ramp;
    return run_load(scenario, [](const LoadProgress&) {}, std::stop_token());
}

/// Until the first group has so many frames and losses.
LoadResult run_until(const FakeServer& server, std::vector<Group> groups, std::uint64_t frames, std::uint64_t lost) {
    return test::run_until(scenario_of(server, std::move(groups)), [=](const LoadProgress& progress) {
        return progress.groups.at(0).frames >= frames && progress.groups[0].lost >= lost;
    });
}

TEST(LoadRun, EveryClientGetsFrames) {
    FakeServer server([](FakeCall& call, int) { stream(call); });
    std::vector<Group> groups{group_of("checking", 3), group_of("decoding", 2)};
    groups[1].decoding = wire::Decoding::kFull;
    const LoadResult result = run(server, groups, 2s);
    ASSERT_EQ(result.groups.size(), 2U);
    for (const GroupResult& group : result.groups) {
        EXPECT_EQ(group.client_fps.size(), group.group.count);
        EXPECT_EQ(group.without_frames(), 0U);
        EXPECT_GT(group.tally.frames, group.group.count);
        EXPECT_GT(group.tally.bytes, 0U);
        EXPECT_EQ(group.tally.failed + group.tally.lost + group.tally.refused + group.tally.not_sent, 0U);
        EXPECT_EQ(group.tally.connected, 0);
        EXPECT_EQ(group.tally.of(Stage::kConnect).count(), group.group.count);
        EXPECT_EQ(group.tally.of(Stage::kFirstFrame).count(), group.group.count);
        EXPECT_EQ(group.tally.of(Stage::kDecode).count(), group.tally.frames);
        EXPECT_EQ(group.tally.of(Stage::kInterval).count(), group.tally.frames - group.group.count);
        // 20 moments per second for two seconds, less what passes before the first frame; one more by the phase.
        EXPECT_LE(group.tally.of(Stage::kDue).count(), 41U * group.group.count);
        EXPECT_GE(group.tally.of(Stage::kDue).count(), 20U * group.group.count);
        EXPECT_GT(group.tally.without_pose_time, 0U); // the script tells no times
        std::uint64_t frames = 0;
        for (const Second& second : group.tally.seconds) {
            frames += second.frames;
        }
        EXPECT_EQ(frames, group.tally.frames);
        EXPECT_LE(group.tally.seconds.size(), 2U);
    }
    EXPECT_NEAR(result.seconds, 2.0, 0.01);
    EXPECT_FALSE(result.was_interrupted);
    EXPECT_GT(result.cpu_seconds, 0.0);
    EXPECT_EQ(server.call_count(), 5);
}

TEST(LoadRun, AStallIsNotHidden) {
    FakeServer server([](FakeCall& call, int) { stream(call, 1, 5); });
    const LoadResult result = run(server, {group_of("stalled", 1)}, 4s);
    const Tally& tally = result.groups[0].tally;
    EXPECT_EQ(tally.frames, 5U);
    EXPECT_GT(tally.cut_off, 10U); // 20 moments per second, most of four seconds
    EXPECT_GT(tally.of(Stage::kDue).largest_us(), 800'000);
    EXPECT_LT(tally.of(Stage::kInterval).largest_us(), 800'000); // which a closed model would have reported
}

TEST(LoadRun, WaitingInVainCountsAlsoForClientsThatLeave) {
    FakeServer server([](FakeCall& call, int) { stream(call, 1, 1); });
    std::vector<Group> groups{group_of("leaving", 2)};
    groups[0].stay = 1s;
    groups[0].away = 100ms;
    const LoadResult result = run(server, groups, 4s);
    const Tally& tally = result.groups[0].tally;
    EXPECT_GT(tally.cut_off, 10U); // of 20 moments per second and client, all after the only frame
    EXPECT_GT(tally.of(Stage::kDue).largest_us(), 200'000); // they stay for at least 500 ms
    EXPECT_THAT(to_table(result), HasSubstr(std::to_string(tally.cut_off) + " of "));
}

TEST(LoadRun, CountsFramesThatWereNotSent) {
    FakeServer server([](FakeCall& call, int) { stream(call, 3); });
    const LoadResult result = run_until(server, {group_of("skipping", 1)}, 2, 0);
    const Tally& tally = result.groups[0].tally;
    EXPECT_EQ(tally.not_sent, 2 * (tally.frames - 1));
}

TEST(LoadRun, DamageIsSeenByThoseWhoLook) {
    FakeServer server([](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        for (std::uint64_t id = 1;; ++id) {
            auto messages = test::views_messages(set, id);
            messages[1].mutable_frame_chunk()->mutable_payload()->back() ^= static_cast<char>(id % 2);
            call.send(messages);
            if (!call.read_until(v1::ClientMessage::kFrameAck)) {
                return;
            }
            test::pass_frame_time(kFrameTime);
        }
    });
    std::vector<Group> groups{group_of("checksum", 1), group_of("headers", 1)};
    groups[1].decoding = wire::Decoding::kHeaders;
    const LoadResult result = test::run_until(scenario_of(server, groups), [](const LoadProgress& progress) {
        return progress.groups.at(0).failed > 0 && progress.groups[0].frames > 0 && progress.groups.at(1).frames > 1;
    });
    EXPECT_THAT(result.groups[0].tally.reasons.begin()->first, HasSubstr("frame failed"));
    EXPECT_EQ(result.groups[1].tally.failed, 0U);
}

TEST(LoadRun, ARefusedClientDoesNotComeBack) {
    FakeServer server([](FakeCall& call, int) {
        call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage message;
        message.mutable_refused()->set_request_id(1);
        message.mutable_refused()->set_reason(v1::REFUSAL_REASON_INVALID);
        message.mutable_refused()->set_message("no");
        call.send(message);
        call.read_rest();
    });
    const LoadResult result = run(server, {group_of("refused", 2)});
    EXPECT_EQ(result.groups[0].tally.refused, 2U);
    EXPECT_EQ(result.groups[0].tally.reasons.at("refused: no"), 2U);
    EXPECT_EQ(result.groups[0].without_frames(), 2U);
    EXPECT_EQ(server.call_count(), 2);
    EXPECT_FALSE(result.has_frames());
    EXPECT_FALSE(result.holds());
}

TEST(LoadRun, ALostClientComesBack) {
    FakeServer server([](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        call.send(test::views_messages(set, 1));
        call.read_until(v1::ClientMessage::kFrameAck);
    });
    const LoadResult result = run_until(server, {group_of("lost", 1)}, 2, 2);
    EXPECT_GE(server.call_count(), 2);
    EXPECT_EQ(result.groups[0].tally.reasons.count("the server finished first"), 1U);
    EXPECT_EQ(result.groups[0].tally.connected, 0);
}

TEST(LoadRun, NobodyThereIsALoss) {
    const test::ClosedPort nobody;
    Scenario scenario;
    scenario.address = nobody.address();
    scenario.groups = {group_of("alone", 2)};
    const LoadResult result =
        test::run_until(scenario, [](const LoadProgress& progress) { return progress.groups.at(0).lost >= 2; });
    EXPECT_FALSE(result.has_frames());
}

TEST(LoadRun, ChurnIsNoLoss) {
    FakeServer server([](FakeCall& call, int) { stream(call); });
    std::vector<Group> groups{group_of("polite", 2), group_of("abrupt", 2)};
    for (Group& group : groups) {
        group.stay = 400ms;
        group.away = 100ms;
    }
    groups[1].leaves_abruptly = true;
    const LoadResult result = run(server, groups, 4s);
    for (const GroupResult& group : result.groups) {
        EXPECT_EQ(group.tally.lost, 0U) << group.group.name;
        EXPECT_GT(group.tally.of(Stage::kConnect).count(), 2U * group.group.count) << group.group.name;
        EXPECT_EQ(group.without_frames(), 0U) << group.group.name;
        EXPECT_EQ(group.tally.connected, 0) << group.group.name;
    }
}

TEST(LoadRun, SlowAndBusyClientsGetFewerFrames) {
    FakeServer server([](FakeCall& call, int) { stream(call); });
    std::vector<Group> groups{group_of("quick", 1), group_of("slow", 1), group_of("busy", 1)};
    groups[1].max_bytes_per_second = 2000.0;
    groups[2].think = 250ms;
    const LoadResult result = run(server, groups, 2s);
    EXPECT_GT(result.groups[0].tally.frames, 2 * result.groups[1].tally.frames);
    EXPECT_GT(result.groups[1].tally.frames, 0U);
    EXPECT_LE(result.groups[1].tally.bytes, 4000U);
    EXPECT_LE(result.groups[2].tally.frames, 8U); // two seconds in steps of 250 ms
    EXPECT_GT(result.groups[2].tally.frames, 1U);
}

TEST(LoadRun, AStopRequestEndsItWithAResult) {
    FakeServer server([](FakeCall& call, int) { stream(call); });
    Scenario scenario;
    scenario.address = server.address();
    scenario.groups = {group_of("stopped", 2)};
    scenario.duration = 0s; // until interrupted
    std::stop_source stop;
    int told = 0;
    const auto on_progress = [&](const LoadProgress& progress) {
        EXPECT_EQ(progress.groups.at(0).clients, 2U);
        told += 1;
        if (progress.groups[0].frames > 4) {
            EXPECT_EQ(progress.groups[0].connected, 2);
            stop.request_stop();
        }
    };
    const LoadResult result = run_load(scenario, on_progress, stop.get_token());
    EXPECT_TRUE(result.was_interrupted);
    EXPECT_GE(told, 1);
    EXPECT_GT(result.groups[0].tally.frames, 4U);
    EXPECT_GT(result.groups[0].mean_fps(), 0.0);
    EXPECT_LT(result.groups[0].mean_fps(), 100.0); // by the script's pace
    EXPECT_LT(result.seconds, 60.0);
}

TEST(LoadRun, TheRampIsNotMeasured) {
    FakeServer server([](FakeCall& call, int) { stream(call); });
    const LoadResult result = run(server, {group_of("ramped", 4)}, 1s, 1s);
    EXPECT_NEAR(result.seconds, 1.0, 0.01);
    EXPECT_EQ(result.groups[0].tally.of(Stage::kConnect).count(), 4U);
    EXPECT_LE(result.groups[0].tally.seconds.size(), 1U);
    for (const double fps : result.groups[0].client_fps) {
        EXPECT_LT(fps, 100.0); // frames of the ramp are not counted against the second of the window
    }
}

} // namespace
} // namespace fieldcast::client::load
