// SPDX-License-Identifier: Apache-2.0
// Sessions of a replayed recording without a transport: everything of the server that has threads of its own, for the
// thread sanitizer. (The distribution's gRPC is built without it, so that handovers between its threads look like
// races.)
#include "core/base/guarded.h"
#include "server/recording/channel_recorder.h"
#include "server/recording/replay.h"
#include "server/session/server_session.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/synthetic_recording.h"

#include <gtest/gtest.h>
#include <thread>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A session as a stream keeps it: frames come from the channel's thread, everything else from the client's.
struct Client {
    Guarded<std::optional<ServerSession>> session;
    std::condition_variable frame_came;

    static std::shared_ptr<Client> open(const std::shared_ptr<feed::Feed>& feed) {
        auto client = std::make_shared<Client>();
        client->session.lock()->emplace(
            std::vector{feed}, Limits{},
            [weak = std::weak_ptr(client)](const feed::FramePtr& frame) {
                if (const auto own = weak.lock()) {
                    (*own->session.lock())->on_frame(frame, Clock::now());
                    own->frame_came.notify_all();
                }
            },
            Clock::now());
        return client;
    }

    void send(const v1::ClientMessage& message) { (*session.lock())->on_message(message, Clock::now()); }

    /// Takes messages until `count` frames are complete, and acknowledges them. Returns how many those were.
    int take_frames(int count) {
        int frames = 0;
        const auto deadline = Clock::now() + 60s;
        while (frames < count && Clock::now() < deadline) {
            auto lock = session.lock();
            const auto chunk = (*lock)->next(Clock::now());
            if (!chunk) {
                lock.wait_until(frame_came, Clock::now() + 50ms, [](const auto&) { return false; });
                continue;
            }
            v1::ServerMessage message;
            EXPECT_TRUE(message.ParseFromString(wire::joined(*chunk)));
            if (message.frame_chunk().has_trailer()) {
                v1::ClientMessage ack;
                ack.mutable_frame_ack()->set_frame_id(message.frame_chunk().frame_id());
                ack.mutable_frame_ack()->set_epoch(message.frame_chunk().epoch());
                ack.mutable_frame_ack()->set_outcome(v1::FRAME_OUTCOME_DECODED);
                (*lock)->on_message(ack, Clock::now());
                ++frames;
            }
        }
        return frames;
    }
};

/// Sessions of both kinds come, change their minds and go while two replays are shown and one of them is recorded
/// again.
TEST(ReplaySessions, ComeAndGo) {
    const test::TestFolder folder;
    test::write_synthetic_recording(folder / "hall.fcrec", {"views:2x2:32x18", "illumination"}, 7);
    metrics::Registry registry;
    recording::Replay replay({.file = folder / "hall.fcrec", .name = "", .frames_per_second = 100.0F}, registry);
    recording::Replay other({.file = folder / "hall.fcrec", .name = "other", .frames_per_second = 80.0F}, registry);
    recording::ChannelRecorder recorder(
        replay.feed(), {.file = folder / "again.fcrec", .selections = replay.feed()->info().recorded, .max_frames = 5},
        registry);
    std::vector<std::jthread> clients;
    for (int i = 0; i < 4; ++i) {
        clients.emplace_back([&, i] {
            for (int round = 0; round < 3; ++round) {
                const auto client = Client::open((i + round) % 2 == 0 ? replay.feed() : other.feed());
                v1::ClientMessage wanted;
                wanted.mutable_configure()->set_keeps_key_frames(i % 2 == 0);
                wanted.mutable_configure()->add_modes(i < 2 ? v1::DELIVERY_MODE_VIEWS : v1::DELIVERY_MODE_SCENE);
                client->send(wanted);
                EXPECT_EQ(client->take_frames(2), 2);
                wanted.mutable_configure()->mutable_grid()->set_rows(1);
                wanted.mutable_configure()->mutable_grid()->set_cols(2);
                client->send(wanted);
                EXPECT_EQ(client->take_frames(2), 2);
                (*client->session.lock())->end();
            }
        });
    }
    EXPECT_NE(registry.page().text().find("fieldcast_replayed_frames_total"), std::string::npos);
    clients.clear();
    EXPECT_EQ(other.feed()->subscriber_count(), 0U);
}

} // namespace
} // namespace fieldcast::session
