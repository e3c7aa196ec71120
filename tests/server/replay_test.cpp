// SPDX-License-Identifier: Apache-2.0
// A recording behind the real service: the server's whole path without Vulkan.
#include "core/lightfield/frame_rate.h"
#include "server/recording/replay.h"
#include "server/service/grpc_server.h"
#include "tests/fixtures/polling.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/server_client.h"
#include "tests/server/synthetic_recording.h"

#include <atomic>
#include <future>
#include <gtest/gtest.h>
#include <thread>

namespace fieldcast::recording {
namespace {

using std::chrono_literals::operator""s;

constexpr std::uint64_t kFrames = 12; ///< of a loop

class ServedReplay : public testing::Test {
protected:
    ServedReplay() {
        test::write_synthetic_recording(file_, {"views:3x3", "g-buffer"}, kFrames);
        replay_.emplace(recording::ReplaySetup{.file = file_, .name = "", .frames_per_second = std::nullopt},
                        *registry_);
        session::Limits limits;
        limits.max_opens_per_second_per_peer = 1000.0; // clients that come and go
        server_.emplace(HostPort{.host = "127.0.0.1", .port = 0},
                        std::vector<std::shared_ptr<feed::Feed>>{replay_->feed()}, limits, access::Security{},
                        service::Observation{.registry = registry_});
    }

    /// What the recording has for `selection` in the frame that became `frame_id`.
    wire::WireFrame recorded(const feed::ViewSelection& selection, std::uint64_t frame_id, bool has_key_frame) {
        const auto frame = recording_->read((frame_id - 1) % kFrames);
        EXPECT_TRUE(frame.has_value());
        return wire::view_chunks(*feed::find_views(*frame, selection.format), selection.grid, {.has_key_frame = has_key_frame});
    }

    /// The next frame as it comes: payloads of all chunks and the trailer's CRC must be those of the recording.
    void expect_next_frame_as_recorded(test::OpenCall& call, const feed::ViewSelection& selection) {
        std::vector<std::string> payloads;
        std::optional<v1::FrameHeader> header;
        for (auto message = call.read_until(v1::ServerMessage::kFrameChunk); message;
             message = call.read_until(v1::ServerMessage::kFrameChunk)) {
            const v1::FrameChunk& chunk = message->frame_chunk();
            if (chunk.has_header()) {
                header = chunk.header();
            }
            payloads.push_back(chunk.payload());
            if (!chunk.has_trailer()) {
                continue;
            }
            ASSERT_TRUE(header.has_value());
            const wire::WireFrame same = recorded(selection, chunk.frame_id(), header->key_frame_id() != 0);
            ASSERT_EQ(payloads.size(), same.chunks.size() + 1);
            for (std::size_t i = 0; i < same.chunks.size(); ++i) {
                const auto bytes = same.chunks[i].payload;
                EXPECT_EQ(payloads[i], std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())) << i;
            }
            EXPECT_EQ(chunk.trailer().crc32c(), same.crc32c);
            EXPECT_EQ(header->cut(), chunk.frame_id() % kFrames == 1);
            EXPECT_EQ(chunk.trailer().discards(0).out_of_frustum(), 1U);
            call.acknowledge(chunk);
            return;
        }
        FAIL() << "the stream ended";
    }

    const test::TestFolder folder_;
    const std::filesystem::path file_ = folder_ / "hall.fcrec";
    const std::shared_ptr<metrics::Registry> registry_ = std::make_shared<metrics::Registry>();
    std::optional<recording::Replay> replay_;
    std::optional<recording::Recording> recording_;
    std::optional<service::GrpcServer> server_;
};

TEST_F(ServedReplay, ClientsGetTheBytesThatWereRecorded) {
    recording_.emplace(file_);
    for (const bool keeps_key_frames : {false, true}) {
        test::OpenCall call(test::connect(server_->port()));
        v1::Configure wanted;
        wanted.mutable_grid()->set_rows(2);
        wanted.mutable_grid()->set_cols(2);
        wanted.set_keeps_key_frames(keeps_key_frames);
        call.configure(wanted);
        feed::ViewSelection selection = std::get<feed::ViewSelection>(recording_->info().recorded.at(0));
        selection.grid.rows = selection.grid.cols = 2;
        for (std::uint64_t i = 0; i < 2 * kFrames; ++i) {
            ASSERT_NO_FATAL_FAILURE(expect_next_frame_as_recorded(call, selection));
        }
        call.half_close();
        EXPECT_TRUE(call.finish().ok());
    }
}

TEST_F(ServedReplay, RefusalsNameWhatWasRecorded) {
    test::OpenCall call(test::connect(server_->port()));
    v1::Configure wanted;
    wanted.mutable_grid()->set_rows(4);
    wanted.mutable_grid()->set_cols(4);
    call.configure(wanted);
    const auto answer = call.read_until(v1::ServerMessage::kRefused);
    ASSERT_TRUE(answer.has_value());
    EXPECT_NE(answer->refused().message().find("recorded: views 3x3 of 64x36 zstd"), std::string::npos);
}

/// Clients of both kinds come, change their minds, stop reading and vanish while frames are published and a scrape asks
/// for numbers; then the server drains. Until the configuration is confirmed. Frames of the one before return their
/// credits, or there may be none left.
bool read_configured(test::OpenCall& call) {
    for (auto message = call.read(); message; message = call.read()) {
        if (message->message_case() == v1::ServerMessage::kConfigured) {
            return true;
        }
        if (message->frame_chunk().has_trailer()) {
            call.acknowledge(message->frame_chunk());
        }
    }
    return false;
}

TEST(Replay, OfFramesANanosecondApartIsBounded) {
    const test::TestFolder folder;
    const auto file = folder / "hasty.fcrec";
    test::write_synthetic_recording(file, {"views:2x2:16x8"}, kFrames, test::synthetic_info("hall"),
                                    std::chrono::nanoseconds(1));
    testing::internal::CaptureStderr();
    metrics::Registry registry;
    recording::Replay replay({.file = file, .name = "", .frames_per_second = std::nullopt}, registry);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("recording faster than it is replayed"), std::string::npos);
    std::atomic<int> frames = 0;
    std::promise<void> enough;
    constexpr int kSeen = 150; // more than half a second's worth: a replay that lags catches up after that
    const auto begin = std::chrono::steady_clock::now();
    const auto watch =
        feed::Feed::subscribe(replay.feed(), replay.feed()->info().recorded.at(0), [&](const feed::FramePtr&) {
            if (++frames == kSeen) {
                enough.set_value();
            }
        });
    ASSERT_TRUE(watch.has_value()) << watch.error();
    ASSERT_EQ(enough.get_future().wait_for(20s), std::future_status::ready);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    EXPECT_GE(took.count(), (kSeen - 1) / static_cast<double>(kMaxFramesPerSecond));
}

TEST_F(ServedReplay, ClientsComeAndGo) {
    std::atomic<std::uint64_t> frames = 0;
    std::vector<std::jthread> clients;
    for (int i = 0; i < 6; ++i) {
        clients.emplace_back([&, i] {
            const auto connection = test::connect(server_->port());
            for (int round = 0; round < 4; ++round) {
                test::OpenCall call(connection);
                v1::Configure wanted;
                wanted.set_keeps_key_frames(round % 2 == 0);
                wanted.add_modes(i % 2 == 0 ? v1::DELIVERY_MODE_VIEWS : v1::DELIVERY_MODE_SCENE);
                for (int epoch = 0; epoch < 2; ++epoch) {
                    ASSERT_TRUE(call.configure(wanted));
                    ASSERT_TRUE(read_configured(call));
                    for (int frame = 0; frame < 3; ++frame) {
                        const auto trailer = call.read_frame();
                        ASSERT_TRUE(trailer.has_value());
                        call.acknowledge(*trailer);
                        ++frames;
                    }
                    wanted.mutable_grid()->set_rows(1);
                    wanted.mutable_grid()->set_cols(2);
                }
                (round + i) % 3 == 0 ? call.cancel() : call.half_close();
            }
        });
    }
    const auto half_has_come = [&] {
        EXPECT_NE(registry_->page().text().find("fieldcast_replayed_frames_total"), std::string::npos);
        return frames >= 6 * 4 * 2 * 3 / 2;
    };
    EXPECT_TRUE(test::comes_true(half_has_come, 60s));
    clients.clear();
    EXPECT_EQ(frames, 6U * 4 * 2 * 3);
    server_->begin_drain("the test is over");
    EXPECT_TRUE(server_->wait_until_drained(std::chrono::steady_clock::now() + 20s));
}

} // namespace
} // namespace fieldcast::recording
