// SPDX-License-Identifier: Apache-2.0
#include "core/wire/frame_assembler.h"
#include "server/service/grpc_server.h"
#include "server/session/credits.h"
#include "tests/server/server_client.h"
#include "tests/server/synthetic.h"

#include <gtest/gtest.h>
#include <thread>
#include <vector>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using grpc::StatusCode;
using Kind = v1::ServerMessage;

constexpr const char* kOpen = "/fieldcast.v1.LightField/Open";
constexpr const char* kHealthCheck = "/grpc.health.v1.Health/Check";
constexpr const char* kReflection = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";

session::Limits test_limits() {
    session::Limits limits;
    limits.max_sessions = 16;
    limits.going_away_deadline = 500ms;
    return limits;
}

v1::Configure selection(v1::DeliveryMode mode) {
    v1::Configure wanted;
    wanted.add_modes(mode);
    wanted.mutable_grid()->set_rows(3);
    wanted.mutable_grid()->set_cols(3);
    return wanted;
}

class Service : public testing::Test {
protected:
    /// The next complete frame, put together and acknowledged.
    std::optional<wire::ReceivedFrame> next_frame(OpenCall& call, wire::FrameAssembler& assembler) {
        while (auto message = call.read_until(Kind::kFrameChunk)) {
            const v1::FrameChunk chunk = message->frame_chunk();
            auto frame = assembler.add(std::move(*message->mutable_frame_chunk()));
            EXPECT_TRUE(frame.has_value()) << frame.error().message;
            if (chunk.has_trailer()) {
                call.acknowledge(chunk);
            }
            if (!frame || *frame) {
                return frame ? std::move(*frame) : std::nullopt;
            }
        }
        return std::nullopt;
    }

    std::string health() {
        std::string answer;
        EXPECT_TRUE(call_raw(*connection_, kHealthCheck, "", answer).ok());
        return answer;
    }

    SyntheticChannel channel_;
    service::GrpcServer server_{{.host = "127.0.0.1", .port = 0}, {channel_.feed()}, test_limits()};
    std::shared_ptr<grpc::Channel> connection_ = connect(server_.port());
};

TEST_F(Service, SendsViews) {
    OpenCall call(connection_);
    call.configure(selection(v1::DELIVERY_MODE_VIEWS));
    const auto configured = call.read_until(Kind::kConfigured);
    ASSERT_TRUE(configured.has_value());
    EXPECT_EQ(configured->configured().view_set().grid().rows(), 3U);
    wire::FrameAssembler assembler;
    assembler.begin_epoch(configured->configured().epoch(), {});
    for (int i = 0; i < 5; ++i) {
        const auto frame = next_frame(call, assembler);
        ASSERT_TRUE(frame.has_value());
        const auto& views = std::get<wire::ReceivedViews>(frame->content).views.views;
        ASSERT_EQ(views.size(), 9U);
        EXPECT_EQ(views[0].position, LatticePosition::whole(-1, -1));
        EXPECT_EQ(views[0].image.width_px, 64U);
        EXPECT_EQ(views[0].discards.out_of_frustum, 1U);
        EXPECT_GT(frame->server_times.send_begin_ns, 0);
    }
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST_F(Service, SendsPlanesWithTheGuardBand) {
    OpenCall call(connection_);
    v1::Configure wanted = selection(v1::DELIVERY_MODE_SCENE);
    wanted.set_planes(v1::PLANE_SET_WITH_G_BUFFER);
    call.configure(wanted);
    const auto configured = call.read_until(Kind::kConfigured);
    ASSERT_TRUE(configured.has_value());
    EXPECT_EQ(configured->configured().planes_size(), 6);
    wire::FrameAssembler assembler;
    assembler.begin_epoch(configured->configured().epoch(), {});
    const auto frame = next_frame(call, assembler);
    ASSERT_TRUE(frame.has_value());
    const auto& source = std::get<SourceFrame>(frame->content);
    ASSERT_EQ(source.planes.size(), 6U);
    EXPECT_EQ(source.planes[0].width_px, 64U + 2 + 3);
    EXPECT_EQ(source.planes[0].height_px, 36U + 1 + 1);
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST_F(Service, RefusesUnknownModesAndCarriesOn) {
    OpenCall call(connection_);
    call.configure(selection(static_cast<v1::DeliveryMode>(99)));
    const auto refused = call.read_until(Kind::kRefused);
    ASSERT_TRUE(refused.has_value());
    EXPECT_EQ(refused->refused().field(), "modes");
    EXPECT_EQ(refused->refused().reason(), v1::REFUSAL_REASON_UNSUPPORTED);
    call.configure(selection(v1::DELIVERY_MODE_VIEWS));
    EXPECT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST_F(Service, EndsStreamsOfGarbage) {
    std::string answer;
    const grpc::Status status = exchange_raw(*connection_, kOpen, "\xFF\xFF\xFF garbage", answer);
    EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT) << status.error_message();
    EXPECT_NE(status.error_message().find("ClientMessage"), std::string::npos);
}

TEST_F(Service, EndsStreamsOfOversizedMessages) {
    std::string answer;
    const std::string large(session::kMaxClientMessageBytes + 1, 'x');
    const grpc::Status status = exchange_raw(*connection_, kOpen, large, answer);
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
    EXPECT_TRUE(server_.wait_until_drained(Clock::now() + kCallDeadline)) << "the session is over";
}

TEST_F(Service, ClientThatNeverAcknowledgesGetsItsCreditsOnly) {
    OpenCall call(connection_);
    call.configure(selection(v1::DELIVERY_MODE_VIEWS));
    std::uint32_t frames = 0;
    for (int heartbeats = 0; frames < session::kMinCredits || heartbeats < 4;) { // four with all credits used
        const auto message = call.read();
        ASSERT_TRUE(message.has_value());
        heartbeats += message->has_heartbeat() && frames == session::kMinCredits ? 1 : 0;
        frames += message->frame_chunk().has_trailer() ? 1U : 0U;
    }
    EXPECT_EQ(frames, session::kMinCredits);
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST_F(Service, ManyClientsComeAndGo) {
    std::vector<std::jthread> clients;
    for (int i = 0; i < 8; ++i) {
        clients.emplace_back([&, i] {
            OpenCall call(connect(server_.port()));
            call.configure(selection(i % 2 == 0 ? v1::DELIVERY_MODE_VIEWS : v1::DELIVERY_MODE_SCENE));
            for (int frame = 0; frame < 5;) {
                const auto message = call.read_until(Kind::kFrameChunk);
                ASSERT_TRUE(message.has_value()) << call.finish().error_message();
                if (message->frame_chunk().has_trailer()) {
                    call.acknowledge(message->frame_chunk());
                    ++frame;
                }
            }
            i < 4 ? call.cancel() : call.half_close();
            EXPECT_EQ(call.finish().ok(), i >= 4);
        });
    }
    clients.clear();
    EXPECT_TRUE(server_.wait_until_drained(Clock::now() + kCallDeadline));
    EXPECT_EQ(channel_.feed()->subscriber_count(), 0U);
}

TEST_F(Service, RefusesSessionsBeyondItsLimit) {
    std::vector<std::unique_ptr<OpenCall>> calls;
    for (std::uint32_t i = 0; i < test_limits().max_sessions; ++i) {
        calls.push_back(std::make_unique<OpenCall>(connection_));
        calls.back()->configure();
        ASSERT_TRUE(calls.back()->read().has_value());
    }
    OpenCall one_more(connection_);
    const grpc::Status status = one_more.finish();
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_NE(status.error_message().find("16"), std::string::npos);
    for (auto& call : calls) {
        call->half_close();
        EXPECT_TRUE(call->finish().ok());
    }
}

TEST_F(Service, DrainsWithClientsThatHalfClose) {
    OpenCall call(connection_);
    call.configure(selection(v1::DELIVERY_MODE_VIEWS));
    ASSERT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    EXPECT_EQ(health(), "\x08\x01"); // status: SERVING
    server_.begin_drain("a test");
    EXPECT_EQ(health(), "\x08\x02"); // status: NOT_SERVING
    const auto going_away = call.read_until(Kind::kGoingAway);
    ASSERT_TRUE(going_away.has_value());
    EXPECT_EQ(going_away->going_away().reason(), "a test");
    EXPECT_EQ(OpenCall(connection_).finish().error_code(), StatusCode::UNAVAILABLE);
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
    EXPECT_TRUE(server_.wait_until_drained(Clock::now() + kCallDeadline));
}

TEST_F(Service, CutsClientsThatDoNotLeave) {
    OpenCall call(connection_);
    call.configure(selection(v1::DELIVERY_MODE_VIEWS));
    ASSERT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    server_.begin_drain("a test");
    EXPECT_EQ(call.finish().error_code(), StatusCode::DEADLINE_EXCEEDED);
    EXPECT_TRUE(server_.wait_until_drained(Clock::now() + kCallDeadline));
}

TEST_F(Service, AnswersTimeSync) {
    OpenCall call(connection_);
    v1::ClientMessage message;
    message.mutable_time_sync()->set_client_send_ns(77);
    call.send(message);
    const auto answer = call.read_until(Kind::kTimeSync);
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->time_sync().client_send_ns(), 77);
    EXPECT_GE(answer->time_sync().server_send_ns(), answer->time_sync().server_receive_ns());
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST_F(Service, ReflectionListsTheServices) {
    std::string answer;
    const std::string list_services = "\x3A\x01*"; // ServerReflectionRequest.list_services = "*"
    EXPECT_TRUE(exchange_raw(*connection_, kReflection, list_services, answer).ok());
    EXPECT_NE(answer.find("fieldcast.v1.LightField"), std::string::npos);
    EXPECT_NE(answer.find("fieldcast.v1.Catalog"), std::string::npos);
}

TEST(ServiceWithoutFrames, HeartbeatsComeTwiceASecond) {
    const auto silent = std::make_shared<feed::Feed>(synthetic_info());
    service::GrpcServer server({.host = "127.0.0.1", .port = 0}, {silent}, test_limits());
    OpenCall call(connect(server.port()));
    call.configure();
    std::int64_t before_ns = INT64_MIN / 2;
    std::int64_t shortest_ns = INT64_MAX; // of several: a busy machine may be late with some of them
    for (int i = 0; i < 6; ++i) {
        const auto message = call.read_until(Kind::kHeartbeat);
        ASSERT_TRUE(message.has_value());
        const std::int64_t now_ns = message->heartbeat().server_time_ns();
        shortest_ns = std::min(shortest_ns, now_ns - before_ns);
        before_ns = now_ns;
    }
    EXPECT_LE(shortest_ns, std::chrono::nanoseconds(500ms).count());
    EXPECT_GE(shortest_ns, std::chrono::nanoseconds(test_limits().heartbeat_interval).count());
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
}

TEST(ServiceShutdown, CutsOpenStreams) {
    auto channel = std::make_unique<SyntheticChannel>();
    auto server = std::make_unique<service::GrpcServer>(HostPort{.host = "127.0.0.1", .port = 0},
                                                        std::vector{channel->feed()}, test_limits());
    OpenCall call(connect(server->port()));
    call.configure();
    ASSERT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    server.reset();
    EXPECT_FALSE(call.finish().ok());
    channel.reset();
}

TEST(ServiceStart, RefusesAPortInUse) {
    const auto silent = std::make_shared<feed::Feed>(synthetic_info());
    const service::GrpcServer first({.host = "127.0.0.1", .port = 0}, {silent}, test_limits());
    EXPECT_THROW(service::GrpcServer({.host = "127.0.0.1", .port = first.port()}, {silent}, test_limits()),
                 std::runtime_error);
}

} // namespace
} // namespace fieldcast::test
