// SPDX-License-Identifier: Apache-2.0
// The load harness against the real service, with synthetic frames instead of rendered ones.
#include "run_until.h"
#include "server/service/grpc_server.h"
#include "tests/server/synthetic.h"

#include <gtest/gtest.h>

namespace fieldcast::client::load {
namespace {

using std::chrono_literals::operator""s;

Group group_of(const std::string& name, std::uint32_t count, std::uint32_t rows, std::uint32_t cols) {
    Group group;
    group.name = name;
    group.count = count;
    group.request.rows = rows;
    group.request.cols = cols;
    group.request.max_frames_per_second = 5.0F;
    group.due_fps = 5.0;
    return group;
}

class LoadService : public testing::Test {
protected:
    LoadResult run(std::vector<Group> groups, const std::function<bool(const LoadProgress&)>& has_enough,
                   Seconds ramp = 2s) {
        Scenario scenario;
        scenario.address = "127.0.0.1:" + std::to_string(server_.port());
        scenario.groups = std::move(groups);
        scenario.ramp = ramp;
        scenario.threads = 2;
        return test::run_until(scenario, has_enough);
    }

    static session::Limits limits() {
        session::Limits limits;
        limits.max_sessions = 256;
        limits.max_sessions_per_peer = 256;
        return limits;
    }

    test::SyntheticChannel channel_;
    service::GrpcServer server_{{.host = "127.0.0.1", .port = 0}, {channel_.feed()}, limits()};
};

TEST_F(LoadService, MixedClientsAllGetTheirFramesUndamaged) {
    std::vector<Group> groups{group_of("thin", 10, 3, 3), group_of("decoding", 4, 1, 2), group_of("planes", 6, 4, 4),
                              group_of("headers", 4, 6, 6)};
    groups[1].decoding = wire::Decoding::kFull;
    groups[2].request.mode = DeliveryMode::kScene;
    groups[3].decoding = wire::Decoding::kHeaders;
    const LoadResult result = run(groups, test::frames_for_everybody(15));
    for (const GroupResult& group : result.groups) {
        const Tally& tally = group.tally;
        EXPECT_EQ(tally.failed + tally.refused + tally.lost, 0U) << group.group.name;
        EXPECT_EQ(group.without_frames(), 0U) << group.group.name;
        EXPECT_LE(group.mean_fps(), 6.0) << group.group.name; // five a second, one more at an end of the window
        EXPECT_GT(tally.not_sent, 0U) << group.group.name;    // the channel makes up to a hundred a second
        EXPECT_EQ(tally.of(Stage::kSend).count(), tally.frames) << group.group.name; // the clocks are in step
    }
}

TEST_F(LoadService, TwoHundredClientsGetEqualShares) {
    // Whoever is not yet connected when the window begins has a smaller share, which is not what this is about.
    const LoadResult result = run({group_of("crowd", 200, 3, 3)}, test::frames_for_everybody(20), 5s);
    const GroupResult& crowd = result.groups.at(0);
    EXPECT_EQ(crowd.tally.failed + crowd.tally.refused + crowd.tally.lost, 0U);
    EXPECT_EQ(crowd.client_fps.size(), 200U);
    EXPECT_EQ(crowd.without_frames(), 0U);
    EXPECT_GE(crowd.fairness, 0.95); // what a deployment is promised
    RecordProperty("fps", std::to_string(crowd.mean_fps()));
}

TEST_F(LoadService, SlowReadersFallBehindAlone) {
    std::vector<Group> groups{group_of("quick", 4, 3, 3), group_of("slow", 4, 3, 3)};
    groups[1].max_bytes_per_second = 4000.0;
    const LoadResult result =
        run(groups, [](const LoadProgress& progress) { return progress.groups.at(0).frames >= 4 * 20; });
    EXPECT_GE(result.groups[0].fairness, 0.95);
    EXPECT_EQ(result.groups[0].without_frames(), 0U);
    EXPECT_GT(result.groups[0].mean_fps(), 2.0 * result.groups[1].mean_fps());
    EXPECT_EQ(result.groups[1].tally.failed + result.groups[1].tally.lost, 0U);
}

} // namespace
} // namespace fieldcast::client::load
