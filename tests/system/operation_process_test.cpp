// SPDX-License-Identifier: Apache-2.0
// What operators look at, on a server that renders: /metrics, --health, logs.
#include "running_server.h"
#include "server_client.h"

#include <csignal>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto kPatience = 60s;

class Operation : public testing::Test {
protected:
    void SetUp() override {
        if (server_.lacks_device()) {
            GTEST_SKIP() << server_.log();
        }
    }

    /// Exit code of `fieldcast-server --health`; what it says goes to `said_`.
    std::optional<int> probe(const std::string& address) {
        Program program(FIELDCAST_SERVER, {"--health", address}, folder_ / "health.txt");
        const auto code = program.exit_code(kPatience);
        said_ = program.text();
        return code;
    }

    /// Gets one frame in that mode and acknowledges it.
    static void watch(OpenCall& call, v1::DeliveryMode mode) {
        v1::Configure wanted;
        wanted.add_modes(mode);
        wanted.mutable_grid()->set_rows(2);
        wanted.mutable_grid()->set_cols(3);
        call.configure(wanted);
        const auto trailer = call.read_frame();
        ASSERT_TRUE(trailer.has_value()) << "the stream ended";
        call.acknowledge(*trailer);
    }

    const TestFolder folder_;
    RunningServer server_{FIELDCAST_SERVER, {"--log-format", "json"}};
    std::string said_;
};

TEST_F(Operation, MetricsTellWhatWasRenderedAndSent) {
    OpenCall thin(connect(server_.port()));
    OpenCall thick(connect(server_.port()));
    watch(thin, v1::DELIVERY_MODE_VIEWS);
    watch(thick, v1::DELIVERY_MODE_SCENE);
    const std::string page = server_.metrics();
    for (const char* const series :
         {"fieldcast_stage_seconds_count{channel=\"atelier\",stage=\"source_trace\"}",
          "fieldcast_render_seconds_count{channel=\"atelier\"}", "fieldcast_encode_seconds_count{channel=\"atelier\"}",
          "fieldcast_frames_rendered_total{channel=\"atelier\"}", "fieldcast_view_pixels_total{channel=\"atelier\"}",
          "fieldcast_hole_pixels_total{channel=\"atelier\",reason=\"id\"}",
          "fieldcast_plane_bytes_total{channel=\"atelier\",plane=\"colour\",codec=\"zstd_filtered\"}",
          "fieldcast_plane_bytes_total{channel=\"atelier\",plane=\"diffuse\",codec=\"zstd_filtered\"}",
          "fieldcast_sent_bytes_total{channel=\"atelier\"}", "process_resident_memory_bytes"}) {
        EXPECT_GT(server_.metric(series), 0.0) << series << " in\n" << page;
    }
    EXPECT_EQ(server_.metric("fieldcast_sessions{channel=\"atelier\",mode=\"views\",grid=\"2x3\"}"), 1.0);
    EXPECT_EQ(server_.metric("fieldcast_sessions{channel=\"atelier\",mode=\"scene\",grid=\"2x3\"}"), 1.0);
    EXPECT_EQ(server_.metric("fieldcast_sessions_opened_total"), 2.0);
    EXPECT_EQ(server_.metric("fieldcast_invalid_samples_total{channel=\"atelier\"}"), 0.0);
}

TEST_F(Operation, HealthIsTrueWhileServingAndWhileDraining) {
    const std::string address = "127.0.0.1:" + std::to_string(server_.port());
    EXPECT_EQ(probe(address), 0);
    EXPECT_EQ(said_, "SERVING\n");
    OpenCall call(connect(server_.port()));
    watch(call, v1::DELIVERY_MODE_VIEWS);
    server_.process().send_signal(SIGTERM);
    ASSERT_TRUE(call.read_until(v1::ServerMessage::kGoingAway).has_value());
    EXPECT_EQ(probe(address), 1);
    EXPECT_EQ(said_, "NOT_SERVING\n");
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
    EXPECT_EQ(server_.process().exit_code(kPatience), 0) << server_.log();
    EXPECT_EQ(probe(address), 1) << "nobody listens any more";
    EXPECT_THAT(said_, HasSubstr(address));
}

TEST_F(Operation, EveryLineOfTheLogIsAnObject) {
    {
        OpenCall call(connect(server_.port()));
        watch(call, v1::DELIVERY_MODE_VIEWS);
        call.half_close();
        EXPECT_TRUE(call.finish().ok());
    }
    server_.process().send_signal(SIGTERM);
    EXPECT_EQ(server_.process().exit_code(kPatience), 0);
    std::set<std::string> events;
    std::istringstream lines(server_.log());
    for (std::string line; std::getline(lines, line);) {
        const auto object = nlohmann::json::parse(line, nullptr, false);
        ASSERT_TRUE(object.is_object()) << line;
        EXPECT_EQ(object.at("time").get<std::string>().size(), std::string("2026-07-31T12:00:00.123Z").size());
        events.insert(object.at("event").get<std::string>());
        if (object.at("event") == "session closed") {
            EXPECT_EQ(object.at("reason"), "finished");
            EXPECT_GE(object.at("frames").get<int>(), 1);
        }
    }
    EXPECT_THAT(events, testing::IsSupersetOf({"channel ready", "SERVING", "session opened", "session closed"}));
}

} // namespace
} // namespace fieldcast::test
