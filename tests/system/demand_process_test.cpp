// SPDX-License-Identifier: Apache-2.0
// A server that renders: what nobody could take is not rendered, and what nobody wants any more is given back.
#include "running_server.h"
#include "tests/server/server_client.h"

#include <gmock/gmock.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using Kind = v1::ServerMessage;
using testing::HasSubstr;

constexpr auto kPatience = 240s; // a software device on a busy machine
constexpr const char* kRendered = "fieldcast_views_total{channel=\"atelier\",step=\"rendered\"}";

v1::Configure grid(std::uint32_t rows, std::uint32_t cols) {
    v1::Configure wanted;
    wanted.mutable_grid()->set_rows(rows);
    wanted.mutable_grid()->set_cols(cols);
    return wanted;
}

/// Four heartbeats of `call`: one second.
testing::AssertionResult wait_a_second(OpenCall& call) {
    for (int i = 0; i < 4; ++i) {
        if (!call.read_until(Kind::kHeartbeat)) {
            return testing::AssertionFailure() << "the stream ended";
        }
    }
    return testing::AssertionSuccess();
}

/// Waits until no more views are rendered; -1 if they never end.
double views_when_quiet(const RunningServer& server, OpenCall& call) {
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    for (double before = -1.0; std::chrono::steady_clock::now() < deadline;) {
        const double now = server.metric(kRendered);
        if (now == before || !wait_a_second(call)) {
            return now;
        }
        before = now;
    }
    return -1.0;
}

TEST(DemandProcess, ViewsOfAClientThatDoesNotAcknowledgeAreNotRendered) {
    RunningServer server(FIELDCAST_SERVER, {"--max-pixels-per-peer", "1000000000"});
    if (server.lacks_device()) {
        GTEST_SKIP() << "no Vulkan device";
    }
    OpenCall silent(connect(server.port()), "", kPatience);
    silent.configure(grid(6, 12));
    const auto first = silent.read_frame();
    ASSERT_TRUE(first.has_value());
    ASSERT_TRUE(silent.read_frame().has_value());
    const double quiet = views_when_quiet(server, silent);
    EXPECT_GT(quiet, 0.0) << "the channel sleeps while nobody could take a frame";
    EXPECT_TRUE(wait_a_second(silent));
    EXPECT_EQ(server.metric(kRendered), quiet);

    OpenCall honest(connect(server.port()), "", kPatience);
    honest.configure(grid(1, 1));
    for (int i = 0; i < 10; ++i) {
        const auto frame = honest.read_frame();
        ASSERT_TRUE(frame.has_value());
        honest.acknowledge(*frame);
    }
    EXPECT_LT(server.metric(kRendered), quiet + 72.0) << "one view each for the honest client, none for the silent one";
    silent.acknowledge(*first);
    EXPECT_TRUE(silent.read_frame().has_value()) << "it counts again";
    EXPECT_TRUE(silent.read_until(Kind::kHeartbeat).has_value());
    silent.half_close();
    EXPECT_TRUE(silent.finish().ok());
    honest.half_close();
    EXPECT_TRUE(honest.finish().ok());
}

TEST(DemandProcess, ViewsThatDoNotFitIntoMemoryAreRefusedUntilOthersHaveLeft) {
    // 20 views of 64×36 pixels, four of them for the renderer, at 232 bytes: 10.7 MB.
    RunningServer server(FIELDCAST_SERVER, {"--accumulate-views", "on", "--max-view-memory", "12000000"});
    if (server.lacks_device()) {
        GTEST_SKIP() << "no Vulkan device";
    }
    OpenCall first(connect(server.port()), "", kPatience);
    first.configure(grid(4, 4));
    ASSERT_TRUE(first.read_frame().has_value());
    OpenCall second(connect(server.port()), "", kPatience);
    v1::Configure smaller = grid(4, 4);
    smaller.set_view_width_px(32);
    smaller.set_view_height_px(18);
    second.configure(smaller);
    const auto refused = second.read_until(Kind::kRefused);
    ASSERT_TRUE(refused.has_value());
    EXPECT_EQ(refused->refused().reason(), v1::REFUSAL_REASON_EXHAUSTED);
    EXPECT_THAT(refused->refused().message(), HasSubstr("10690560 of 12000000 are in use"));
    first.half_close();
    EXPECT_TRUE(first.finish().ok());

    const auto deadline = std::chrono::steady_clock::now() + 60s;
    bool is_granted = false;
    while (!is_granted && std::chrono::steady_clock::now() < deadline) {
        second.configure(smaller);
        auto answer = second.read();
        while (answer && !answer->has_configured() && !answer->has_refused()) {
            answer = second.read();
        }
        ASSERT_TRUE(answer.has_value());
        is_granted = answer->has_configured() || !wait_a_second(second);
    }
    EXPECT_TRUE(is_granted);
    EXPECT_TRUE(second.read_frame().has_value());
    second.half_close();
    EXPECT_TRUE(second.finish().ok());
}

} // namespace
} // namespace fieldcast::test
