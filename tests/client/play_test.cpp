// SPDX-License-Identifier: Apache-2.0
// Receiving with reconnects, and whole runs of `play` in mode views, against a server that follows a script.
#include "client/play/playback.h"
#include "tests/client/fake_server.h"
#include "tests/fixtures/test_folder.h"

#include "core/image/image_file.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <iterator>
#include <latch>

namespace fieldcast::test {
namespace {

using namespace client;
using std::chrono_literals::operator""ms;
using testing::HasSubstr;

namespace fs = std::filesystem;

play::ServerOptions server_options(const FakeServer& server, bool reconnects = true) {
    return {.address = server.address(), .reconnects = reconnects, .patience = 10'000ms};
}

net::Request small_request() {
    net::Request request;
    request.rows = 1;
    request.cols = 2;
    return request;
}

class PlayTest : public testing::Test {
protected:
    play::PlayOptions options(const FakeServer& server) const {
        play::PlayOptions options;
        options.server = server_options(server);
        options.request = small_request();
        options.out = folder_;
        return options;
    }

    /// First byte of a view that was written.
    int grey_of(const fs::path& file) const {
        std::ifstream in(folder_ / file, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(in)), {});
        return image::decode_rgba8(std::as_bytes(std::span(bytes)), file, {}).pixels.front();
    }

    const TestFolder own_;
    const fs::path folder_ = own_ / "out"; ///< is not there yet
    std::stop_source stop_;
};

/// Sends the next frame when the one before was acknowledged.
void send_frames(FakeCall& call, std::uint64_t first_id, std::uint64_t count) {
    const wire::ViewSet set = call.grant();
    for (std::uint64_t id = first_id; id < first_id + count; ++id) {
        call.send(views_messages(set, id));
        call.read_until(v1::ClientMessage::kFrameAck);
    }
}

/// Frames until the client leaves: one that writes slowly shows the newest, and leaves others out.
void send_frames(FakeCall& call) {
    const wire::ViewSet set = call.grant();
    std::uint64_t id = 1;
    do {
        call.send(views_messages(set, id++));
    } while (call.read_until(v1::ClientMessage::kFrameAck));
}

TEST_F(PlayTest, WritesTheLastFrame) {
    const FakeServer server([](FakeCall& call, int) {
        send_frames(call, 1, 20);
        call.read_rest();
    });
    play::PlayOptions wanted = options(server);
    wanted.frames = 1;
    std::uint64_t reports = 0;
    const play::PlayResult result = play::play(
        wanted, [&](const play::Progress&) { ++reports; }, stop_.get_token());
    EXPECT_FALSE(result.failure);
    EXPECT_EQ(reports, 1U);
    EXPECT_EQ(result.summary.shown, 1U);
    EXPECT_EQ(result.summary.view_size, "64x36");
    EXPECT_EQ(grey_of("view_r0_c1.png"), fake_grey(result.summary.frame_ids.front()));
    EXPECT_TRUE(fs::exists(folder_ / "quilt_qs2x1a1.778.png"));
}

TEST_F(PlayTest, WritesEveryFrameInAFolderOfItsOwn) {
    const FakeServer server([](FakeCall& call, int) {
        send_frames(call);
    });
    play::PlayOptions wanted = options(server);
    wanted.frames = 3;
    wanted.save = play::Save::kAll;
    const play::PlayResult result = play::play(
        wanted, [](const play::Progress&) {}, stop_.get_token());
    ASSERT_EQ(result.summary.frame_ids.size(), 3U);
    for (const std::uint64_t id : result.summary.frame_ids) {
        std::string name = std::to_string(id);
        name = "frame_" + std::string(8 - name.size(), '0') + name;
        EXPECT_EQ(grey_of(name + "/view_r0_c0.png"), fake_grey(id));
    }
}

TEST_F(PlayTest, WritesNothingWhenToldSo) {
    const FakeServer server([](FakeCall& call, int) {
        send_frames(call, 1, 1);
        call.read_rest();
    });
    play::PlayOptions wanted = options(server);
    wanted.frames = 1;
    wanted.save = play::Save::kNone;
    play::play(
        wanted, [](const play::Progress&) {}, stop_.get_token());
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(PlayTest, StopRequestKeepsTheLastFrameAndEndsInOrder) {
    std::latch half_closed(1);
    const FakeServer server([&](FakeCall& call, int) {
        send_frames(call, 1, 1);
        call.read_rest();
        half_closed.count_down();
    });
    const play::PlayOptions wanted = options(server); // no end
    const auto on_progress = [&](const play::Progress&) { stop_.request_stop(); };
    const play::PlayResult result = play::play(wanted, on_progress, stop_.get_token());
    half_closed.wait(); // the client ended its side first
    EXPECT_FALSE(result.failure);
    EXPECT_EQ(grey_of("view_r0_c0.png"), fake_grey(1));
}

TEST_F(PlayTest, SceneWithoutADeviceSaysWhatWorks) {
    const FakeServer server([](FakeCall&, int) {});
    play::PlayOptions wanted = options(server);
    wanted.request.mode = DeliveryMode::kScene;
    wanted.device = "no device is called like this";
    try {
        play::play(
            wanted, [](const play::Progress&) {}, stop_.get_token());
        FAIL() << "there is no such device";
    } catch (const play::NoDeviceForViews& error) {
        EXPECT_THAT(error.what(), HasSubstr("--mode views"));
    }
    EXPECT_EQ(server.call_count(), 0);
}

TEST_F(PlayTest, ChangesOnTheRunningStream) {
    const FakeServer server([](FakeCall& call, int) {
        send_frames(call, 1, 2);
        const wire::ViewSet changed = call.grant();
        for (std::uint64_t id = 3; id < 20; ++id) {
            call.send(views_messages(changed, id, 2));
            call.read_until(v1::ClientMessage::kFrameAck);
        }
        call.read_rest();
    });
    play::PlayOptions wanted = options(server);
    wanted.frames = 3;
    wanted.changes.push_back({.moment = {.frames = 2}, .request = wanted.request});
    wanted.changes[0].request.cols = 3;
    const play::PlayResult result = play::play(
        wanted, [](const play::Progress&) {}, stop_.get_token());
    EXPECT_FALSE(result.failure);
    EXPECT_EQ(result.summary.counts.sessions, 1U);
    EXPECT_EQ(result.summary.counts.changes, 1U);
    ASSERT_GE(result.summary.epochs.size(), 1U);
    const play::EpochSummary& last = result.summary.epochs.back();
    EXPECT_EQ(last.epoch, 2U);
    EXPECT_EQ(last.grid, "1x3");
    EXPECT_EQ(result.summary.grid, "1x3");
    EXPECT_GE(last.first_frame, 3U);
    EXPECT_TRUE(fs::exists(folder_ / "view_r0_c2.png")) << "the third view came with the change";
}

TEST(ChangeSchedule, GivesEachChangeOnceAndInOrder) {
    using std::chrono_literals::operator""s;
    const play::ChangeSchedule::TimePoint start{};
    std::vector<play::Change> changes{{.moment = {.after = 3000ms}, .request = {}}, {.moment = {.frames = 2}, .request = {}}};
    changes[1].request.rows = 9;
    play::ChangeSchedule schedule(changes);
    EXPECT_FALSE(schedule.due(start + 10s)) << "not before the first agreement";
    schedule.agreed(start);
    schedule.frame_arrived();
    schedule.frame_arrived();
    EXPECT_FALSE(schedule.due(start + 2999ms)) << "the second waits for the first";
    EXPECT_TRUE(schedule.due(start + 3s));
    EXPECT_EQ(schedule.due(start + 3s)->rows, 9U);
    EXPECT_FALSE(schedule.due(start + 99s));
}

TEST(Receiver, ComesBackWhenTheServerGoesAway) {
    const FakeServer server([](FakeCall& call, int number) {
        send_frames(call, number == 0 ? 1 : 100, 1);
        if (number == 0) {
            v1::ServerMessage leaving;
            leaving.mutable_going_away()->set_deadline_ms(5000);
            call.send(leaving);
        }
        call.read_rest(); // the client half-closes first
    });
    play::Receiver receiver(server_options(server), small_request(), std::nullopt);
    const auto first = receiver.take({});
    ASSERT_TRUE(first);
    EXPECT_EQ(first->arrived.frame_id, 1U);
    const auto second = receiver.take({});
    ASSERT_TRUE(second);
    EXPECT_EQ(second->arrived.frame_id, 100U);
    EXPECT_EQ(receiver.counts().sessions, 2U);
    EXPECT_FALSE(receiver.failure());
}

TEST(Receiver, FailsWithoutReconnects) {
    const FakeServer server([](FakeCall& call, int) { send_frames(call, 1, 1); });
    play::Receiver receiver(server_options(server, false), small_request(), std::nullopt);
    while (receiver.take({})) {
    }
    ASSERT_TRUE(receiver.failure());
    EXPECT_EQ(receiver.failure()->message, "the server finished");
}

TEST(Receiver, DoesNotRepeatARefusedRequest) {
    const FakeServer server([](FakeCall& call, int) {
        call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage message;
        message.mutable_refused()->set_request_id(1);
        message.mutable_refused()->set_reason(v1::REFUSAL_REASON_NOT_FOUND);
        message.mutable_refused()->set_message("no such channel");
        call.send(message);
        call.read_rest();
    });
    play::Receiver receiver(server_options(server), small_request(), std::nullopt);
    EXPECT_FALSE(receiver.take({}));
    ASSERT_TRUE(receiver.failure());
    EXPECT_TRUE(receiver.failure()->was_refused);
    EXPECT_EQ(server.call_count(), 1);
}

TEST(Receiver, LeavesAServerThatShowsAnotherScene) {
    const FakeServer server([](FakeCall& call, int) {
        call.grant(); // of scene ABAB…
        call.read_rest();
    });
    play::Receiver receiver(server_options(server), small_request(), scene::SceneHash{});
    EXPECT_FALSE(receiver.take({}));
    ASSERT_TRUE(receiver.failure());
    EXPECT_THAT(receiver.failure()->message, HasSubstr("another scene"));
}

TEST(Receiver, DropsAFrameWhenANewerOneIsComplete) {
    std::latch all_sent(1);
    Guarded<std::vector<v1::FrameOutcome>> outcomes;
    const FakeServer server([&](FakeCall& call, int) {
        const wire::ViewSet set = call.grant();
        call.send(views_messages(set, 1));
        call.send(views_messages(set, 2));
        for (int i = 0; i < 3; ++i) { // two decoded, and one superseded
            const auto ack = call.read_until(v1::ClientMessage::kFrameAck);
            outcomes.lock()->push_back(ack->frame_ack().outcome());
        }
        all_sent.count_down();
        call.read_rest();
    });
    play::Receiver receiver(server_options(server), small_request(), std::nullopt);
    all_sent.wait();
    const auto newest = receiver.take({});
    ASSERT_TRUE(newest);
    EXPECT_EQ(newest->arrived.frame_id, 2U);
    EXPECT_EQ(receiver.counts().superseded, 1U);
    EXPECT_THAT(*outcomes.lock(), testing::Contains(v1::FRAME_OUTCOME_SUPERSEDED));
}

} // namespace
} // namespace fieldcast::test
