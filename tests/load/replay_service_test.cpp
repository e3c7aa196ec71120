// SPDX-License-Identifier: Apache-2.0
// A recording behind the real service, with many clients: the whole path without Vulkan.
#include "run_until.h"
#include "server/recording/replay.h"
#include "server/service/grpc_server.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/synthetic_recording.h"

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
                        std::vector<std::shared_ptr<feed::Feed>>{replay_->feed()}, limits, access::Security{},
                        service::Observation{.registry = registry_});
    }

    const test::TestFolder folder_;
    const std::filesystem::path file_ = folder_ / "hall.fcrec";
    const std::shared_ptr<metrics::Registry> registry_ = std::make_shared<metrics::Registry>();
    std::optional<recording::Replay> replay_;
    std::optional<service::GrpcServer> server_;
};

TEST_F(ReplayService, ManyClientsComeAndGo) {
    Scenario scenario;
    scenario.address = "127.0.0.1:" + std::to_string(server_->port());
    scenario.ramp = 1s;
    scenario.threads = 2;
    for (const char* const name : {"thin", "planes", "decoding", "churn"}) {
        Group& group = scenario.groups.emplace_back();
        group.name = name;
        group.count = 4;
        group.request.rows = group.request.cols = 3;
        group.due_fps = 5.0;
    }
    scenario.groups[1].request.mode = DeliveryMode::kScene;
    scenario.groups[2].decoding = wire::Decoding::kFull;
    scenario.groups[3].stay = 400ms;
    scenario.groups[3].away = 100ms;
    scenario.groups[3].leaves_abruptly = true;
    const LoadResult result = test::run_until(scenario, test::frames_for_everybody(10));
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
