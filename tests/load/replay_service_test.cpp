// SPDX-License-Identifier: Apache-2.0
// A recording behind the real service, with clients of both kinds: the whole path without Vulkan. Also for the thread
// sanitizer.
#include "client/load/load_run.h"
#include "server/recording/replay.h"
#include "server/service/grpc_server.h"
#include "server_client.h"
#include "server_synthetic_recording.h"
#include "test_folder.h"

#include <gtest/gtest.h>

namespace fieldcast::client::load {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

constexpr std::uint64_t kFrames = 12; ///< of a loop

class ReplayService : public testing::Test {
protected:
    ReplayService() {
        test::write_synthetic_recording(file_, {"views:3x3", "g-buffer"}, kFrames);
        replay_.emplace(recording::ReplaySetup{.file = file_, .name = "", .frames_per_second = std::nullopt},
                        *registry_);
        session::Limits limits;
        limits.max_opens_per_second_per_peer = 1000.0; // clients that come and go
        server_.emplace(HostPort{.host = "127.0.0.1", .port = 0},
                        std::vector<std::shared_ptr<feed::Feed>>{replay_->feed()}, limits, access::Security{}, registry_);
    }

    /// What the recording has for `wish` in the frame that became `frame_id`.
    wire::WireFrame recorded(const feed::ViewsWish& wish, std::uint64_t frame_id, bool has_key_frame) {
        const auto frame = recording_->read((frame_id - 1) % kFrames);
        EXPECT_TRUE(frame.has_value());
        return wire::view_chunks(*feed::find_views(*frame, wish.format), wish.grid, {.has_key_frame = has_key_frame});
    }

    /// The next frame as it comes: payloads of all chunks and the trailer's CRC must be those of the recording.
    void expect_next_frame_as_recorded(test::OpenCall& call, const feed::ViewsWish& wish) {
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
            const wire::WireFrame same = recorded(wish, chunk.frame_id(), header->key_frame_id() != 0);
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
    std::optional<recording::Recording> recording_{};
    std::optional<service::GrpcServer> server_;
};

TEST_F(ReplayService, ClientsGetTheBytesThatWereRecorded) {
    recording_.emplace(file_);
    for (const bool keeps_key_frames : {false, true}) {
        test::OpenCall call(test::connect(server_->port()));
        v1::Configure wanted;
        wanted.mutable_grid()->set_rows(2);
        wanted.mutable_grid()->set_cols(2);
        wanted.set_keeps_key_frames(keeps_key_frames);
        call.configure(wanted);
        feed::ViewsWish wish = std::get<feed::ViewsWish>(recording_->info().recorded.at(0));
        wish.grid.rows = wish.grid.cols = 2;
        for (std::uint64_t i = 0; i < 2 * kFrames; ++i) {
            ASSERT_NO_FATAL_FAILURE(expect_next_frame_as_recorded(call, wish));
        }
        call.half_close();
        EXPECT_TRUE(call.finish().ok());
    }
}

TEST_F(ReplayService, RefusalsNameWhatWasRecorded) {
    test::OpenCall call(test::connect(server_->port()));
    v1::Configure wanted;
    wanted.mutable_grid()->set_rows(4);
    wanted.mutable_grid()->set_cols(4);
    call.configure(wanted);
    const auto answer = call.read_until(v1::ServerMessage::kRefused);
    ASSERT_TRUE(answer.has_value());
    EXPECT_NE(answer->refused().message().find("recorded: views 3x3 of 64x36 zstd"), std::string::npos);
}

TEST_F(ReplayService, ManyClientsComeAndGo) {
    Scenario scenario;
    scenario.address = "127.0.0.1:" + std::to_string(server_->port());
    scenario.ramp = 1s;
    scenario.duration = 3s;
    scenario.threads = 2;
    for (const char* const name : {"thin", "planes", "decoding", "churn"}) {
        Group& group = scenario.groups.emplace_back();
        group.name = name;
        group.count = 4;
        group.wish.rows = group.wish.cols = 3;
        group.due_fps = 5.0;
    }
    scenario.groups[1].wish.mode = net::Mode::kScene;
    scenario.groups[2].decoding = wire::Decoding::kFull;
    scenario.groups[3].stay = 300ms;
    scenario.groups[3].away = 100ms;
    scenario.groups[3].leaves_abruptly = true;
    const LoadResult result = run_load(scenario, [](const LoadProgress&) {}, std::stop_token());
    for (const GroupResult& group : result.groups) {
        EXPECT_EQ(group.tally.failed + group.tally.refused + group.tally.lost, 0U) << group.group.name;
        EXPECT_EQ(group.without_frames(), 0U) << group.group.name;
        EXPECT_GT(group.tally.frames, 0U) << group.group.name;
    }
    server_->begin_drain("the test is over");
    EXPECT_TRUE(server_->wait_until_drained(std::chrono::steady_clock::now() + 20s));
}

} // namespace
} // namespace fieldcast::client::load
