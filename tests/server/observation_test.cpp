// SPDX-License-Identifier: Apache-2.0
// What the gRPC edge says about itself: counters, gauges, health.
#include "server/service/grpc_server.h"
#include "server/service/health_probe.h"
#include "tests/fixtures/polling.h"
#include "tests/server/no_descriptors.h"
#include "tests/server/server_client.h"
#include "tests/server/synthetic.h"

#include <algorithm>
#include <cctype>
#include <gmock/gmock.h>
#include <vector>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using Kind = v1::ServerMessage;

constexpr auto kPatience = 20s; // of a test on a busy machine

class Observation : public testing::Test {
protected:
    std::unique_ptr<service::GrpcServer> serve(const std::shared_ptr<feed::Feed>& channel,
                                               const session::Limits& limits = {}) {
        return std::make_unique<service::GrpcServer>(HostPort{.host = "127.0.0.1", .port = 0}, std::vector{channel},
                                                     limits, access::Security{},
                                                     service::Observation{.registry = registry_});
    }

    std::string page() { return registry_->page().text(); }

    /// Waits until the page shows `text`: sessions end a moment after their client has seen the end.
    testing::AssertionResult shows(const std::string& text) {
        if (comes_true([&] { return page().find(text) != std::string::npos; }, kPatience)) {
            return testing::AssertionSuccess();
        }
        return testing::AssertionFailure() << text << " is not in\n" << page();
    }

    testing::AssertionResult lacks(const std::string& text) {
        if (comes_true([&] { return page().find(text) == std::string::npos; }, kPatience)) {
            return testing::AssertionSuccess();
        }
        return testing::AssertionFailure() << text << " is still in\n" << page();
    }

    static std::optional<std::string> health(const service::GrpcServer& server) {
        return service::health_problem({.address = {.host = "127.0.0.1", .port = server.port()}});
    }

    const std::shared_ptr<metrics::Registry> registry_ = std::make_shared<metrics::Registry>();
};

TEST_F(Observation, NeverSaysServingWhileItsPortIsDeaf) {
    if (kNeedsDescriptors) {
        GTEST_SKIP() << "the sanitizer needs descriptors of its own";
    }
    SyntheticChannel channel;
    session::Limits limits;
    limits.probe_interval = 10ms;
    limits.probe_patience = 500ms;
    const auto server = serve(channel.feed(), limits);
    const auto connection = connect(server->port());
    const auto told = [&] {
        std::string answer;
        EXPECT_TRUE(call_raw(*connection, "/grpc.health.v1.Health/Check", "", answer).ok());
        return answer;
    };
    EXPECT_EQ(told(), "\x08\x01") << "SERVING";
    EXPECT_TRUE(shows("fieldcast_serving 1\n"));
    {
        const NoDescriptors none;
        EXPECT_TRUE(shows("fieldcast_serving 0\n"));
        EXPECT_EQ(told(), "\x08\x02") << "NOT_SERVING, on a connection that was there before";
        EXPECT_TRUE(lacks("fieldcast_connections_failed_total 0\n"));
    }
    EXPECT_TRUE(shows("fieldcast_serving 1\n"));
    EXPECT_EQ(told(), "\x08\x01");
}

TEST_F(Observation, CountsFramesBytesAndSessions) {
    SyntheticChannel channel;
    const auto server = serve(channel.feed());
    EXPECT_THAT(page(), HasSubstr("fieldcast_frames_sent_total{channel=\"synthetic\"} 0\n"));
    OpenCall call(connect(server->port()));
    v1::Configure wanted;
    wanted.mutable_grid()->set_rows(2);
    wanted.mutable_grid()->set_cols(3);
    call.configure(wanted);
    const feed::Selection planes = feed::PlaneSelection{.choices = {{.semantic = PlaneSemantic::kDiffuse}}};
    const auto recorder = feed::Feed::subscribe(channel.feed(), planes, [](const feed::FramePtr&) {});
    ASSERT_TRUE(recorder.has_value()) << "the channel goes on, whoever else has room";
    std::uint64_t payload_bytes = 0;
    for (int frames = 0; frames < 2;) { // two are what a client may have without acknowledging
        const auto message = call.read_until(Kind::kFrameChunk);
        ASSERT_TRUE(message.has_value());
        payload_bytes += message->frame_chunk().payload().size();
        frames += message->frame_chunk().has_trailer() ? 1 : 0;
    }
    EXPECT_TRUE(shows("fieldcast_frames_sent_total{channel=\"synthetic\"} 2\n"));
    EXPECT_TRUE(shows("fieldcast_sessions{channel=\"synthetic\",mode=\"views\",grid=\"2x3\"} 1\n"));
    EXPECT_TRUE(shows("fieldcast_frames_in_flight{channel=\"synthetic\"} 2\n"));
    EXPECT_TRUE(shows("fieldcast_plane_bytes_total{channel=\"synthetic\",plane=\"colour\",codec=\"zstd\"} " +
                      std::to_string(payload_bytes) + "\n"));
    EXPECT_TRUE(lacks("fieldcast_frames_dropped_total{channel=\"synthetic\",reason=\"no_credit\"} 0\n"))
        << "the channel goes on";
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
    EXPECT_TRUE(shows("fieldcast_sessions_closed_total{reason=\"finished\"} 1\n"));
    EXPECT_THAT(page(), HasSubstr("fieldcast_sessions_opened_total 1\n"));
    EXPECT_THAT(page(), HasSubstr("fieldcast_bytes_in_flight{channel=\"synthetic\"} 0\n"));
    EXPECT_THAT(page(), Not(HasSubstr("fieldcast_sessions{")));
}

TEST_F(Observation, CountsPlanesOfModeScene) {
    SyntheticChannel channel;
    const auto server = serve(channel.feed());
    OpenCall call(connect(server->port()));
    v1::Configure wanted;
    wanted.add_modes(v1::DELIVERY_MODE_SCENE);
    wanted.set_planes(v1::PLANE_SET_WITH_G_BUFFER);
    call.configure(wanted);
    ASSERT_TRUE(call.read_frame().has_value());
    for (const char* const plane : {"diffuse", "specular", "depth", "normal", "id", "material"}) {
        EXPECT_TRUE(shows("plane=\"" + std::string(plane) + "\",codec=\"zstd\"} "));
    }
    EXPECT_TRUE(shows("mode=\"scene\""));
    call.cancel();
    EXPECT_FALSE(call.finish().ok());
    EXPECT_TRUE(shows("fieldcast_sessions_closed_total{reason=\"cancelled\"} 1\n"));
}

TEST_F(Observation, CountsSessionsOfEveryModeByItsName) {
    SyntheticChannel channel;
    const auto server = serve(channel.feed());
    const google::protobuf::EnumDescriptor& modes = *v1::DeliveryMode_descriptor();
    for (int i = 1; i < modes.value_count(); ++i) { // 0 is none
        OpenCall call(connect(server->port()));
        v1::Configure wanted;
        wanted.add_modes(static_cast<v1::DeliveryMode>(modes.value(i)->number()));
        call.configure(wanted);
        ASSERT_TRUE(call.read_until(Kind::kConfigured).has_value());
        std::string name = modes.value(i)->name().substr(std::string("DELIVERY_MODE_").size());
        std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
        EXPECT_TRUE(shows("fieldcast_sessions{channel=\"synthetic\",mode=\"" + name + "\",grid=\"6x6\"} 1\n"));
        call.half_close();
        EXPECT_TRUE(call.finish().ok());
    }
}

TEST_F(Observation, CountsRefusalsByWhatWasExceeded) {
    SyntheticChannel channel;
    session::Limits limits;
    limits.max_sessions = 1;
    const auto server = serve(channel.feed(), limits);
    OpenCall first(connect(server->port()));
    v1::Configure too_large;
    too_large.mutable_grid()->set_rows(73);
    first.configure(too_large);
    ASSERT_TRUE(first.read_until(Kind::kRefused).has_value());
    EXPECT_TRUE(shows("fieldcast_configurations_refused_total{channel=\"\"} 1\n"));
    EXPECT_TRUE(shows("fieldcast_sessions{channel=\"\",mode=\"\",grid=\"\"} 1\n"));
    EXPECT_FALSE(OpenCall(connect(server->port())).finish().ok());
    EXPECT_TRUE(shows("fieldcast_sessions_refused_total{reason=\"sessions\"} 1\n"));
    server->begin_drain("a test");
    EXPECT_FALSE(OpenCall(connect(server->port())).finish().ok());
    EXPECT_TRUE(shows("fieldcast_sessions_refused_total{reason=\"draining\"} 1\n"));
    first.half_close();
    first.finish();
    EXPECT_TRUE(shows("fieldcast_sessions_closed_total{reason=\"drained\"} 1\n"));
}

/// A client hears that its stream is over before the server has put the session away: whoever drains in between meets
/// sessions that have ended already. Many at once, again and again, as the moment is short.
TEST_F(Observation, ADrainDoesNotTakeClientsThatHaveLeftAlready) {
    constexpr int kRounds = 20;
    constexpr int kClients = 8;
    for (int round = 0; round < kRounds; ++round) {
        const auto server = serve(std::make_shared<feed::Feed>(synthetic_info()));
        std::vector<std::unique_ptr<OpenCall>> calls;
        for (int i = 0; i < kClients; ++i) {
            calls.push_back(std::make_unique<OpenCall>(connect(server->port())));
            calls.back()->configure();
            ASSERT_TRUE(calls.back()->read_until(Kind::kConfigured).has_value());
        }
        for (const auto& call : calls) {
            call->half_close();
        }
        for (const auto& call : calls) {
            EXPECT_TRUE(call->finish().ok());
        }
        server->begin_drain("a test");
        EXPECT_TRUE(server->wait_until_drained(std::chrono::steady_clock::now() + kPatience));
    }
    EXPECT_TRUE(shows("fieldcast_sessions_closed_total{reason=\"finished\"} " + std::to_string(kRounds * kClients)));
}

TEST_F(Observation, HealthSaysServingUntilItDrains) {
    SyntheticChannel channel;
    const auto server = serve(channel.feed());
    EXPECT_EQ(health(*server), std::nullopt);
    EXPECT_THAT(page(), HasSubstr("fieldcast_serving 1\n"));
    server->begin_drain("a test");
    EXPECT_EQ(health(*server), "NOT_SERVING");
    EXPECT_THAT(page(), HasSubstr("fieldcast_serving 0\n"));
}

TEST_F(Observation, HealthFollowsAChannelThatHangs) {
    const auto silent = std::make_shared<feed::Feed>(synthetic_info()); // nobody publishes, as if the device hung
    session::Limits limits;
    limits.channel_deadline = 300ms;
    const auto server = serve(silent, limits);
    EXPECT_EQ(health(*server), std::nullopt) << "nobody waits";
    OpenCall call(connect(server->port()));
    call.configure();
    ASSERT_TRUE(call.read_until(Kind::kConfigured).has_value());
    EXPECT_TRUE(shows("fieldcast_serving 0\n"));
    EXPECT_EQ(health(*server), "NOT_SERVING");
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
    EXPECT_TRUE(shows("fieldcast_serving 1\n")) << "nobody waits any more";
    EXPECT_EQ(health(*server), std::nullopt);
}

TEST(HealthProbe, SaysWhyThereIsNoAnswer) {
    const auto problem = service::health_problem({.address = {.host = "127.0.0.1", .port = 1}, .timeout = 2s});
    EXPECT_THAT(problem.value_or(""), HasSubstr("127.0.0.1:1: "));
}

} // namespace
} // namespace fieldcast::test
