// SPDX-License-Identifier: Apache-2.0
// Clients that misbehave: each is detected, counted by reason and closed, and a client that behaves notices nothing.
#include "http_client.h"
#include "relay.h"
#include "server/session/credits.h"
#include "served_channel.h"
#include "session_count.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using Clock = std::chrono::steady_clock;
using Kind = v1::ServerMessage;

std::string closed(const char* reason) {
    return "fieldcast_sessions_closed_total{reason=\"" + std::string(reason) + "\"}";
}

/// Deadlines short enough to wait for. A bystander acknowledges within milliseconds.
session::Limits short_limits() {
    session::Limits limits;
    limits.configure_deadline = 500ms;
    limits.stall_deadline = 1500ms;
    limits.going_away_deadline = 300ms;
    limits.handshake_deadline = 700ms;
    limits.idle_deadline = 700ms;
    limits.max_messages_per_second = 300.0; // thrice what a bystander acknowledges
    return limits;
}

class Hostile : public testing::Test {
protected:
    void SetUp() override { ASSERT_TRUE(bystander_.gets_more_frames()); }

    /// That one session was closed for `reason`, nobody but the bystander is left, and the bystander notices nothing.
    void expect_closed_for(const char* reason) {
        EXPECT_TRUE(served_.shows(closed(reason), 1));
        EXPECT_TRUE(test::comes_to_sessions(served_.server(), 1));
        EXPECT_TRUE(bystander_.gets_more_frames());
    }

    /// 36 views of 7 KB each: more than a small window.
    static v1::Configure large_frames() {
        v1::Configure wanted;
        v1::CodecPreference& preference = *wanted.add_codecs();
        preference.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
        preference.add_codecs(v1::CODEC_RAW);
        return wanted;
    }

    ServedChannel served_{short_limits()};
    Bystander bystander_{served_.port()};
};

TEST_F(Hostile, ASlowReaderCostsItsCreditsAndGetsTheNewestFrames) {
    constexpr double kFrameBytes = 36 * (64.0 * 36 * 3 + 1024); // payload, and more than the strips' headers need
    constexpr int kFrames = 6;
    OpenCall call(connect_with_small_window(served_.port()));
    call.configure(large_frames());
    std::uint64_t first_id = 0;
    std::uint64_t last_id = 0;
    for (int i = 0; i < kFrames; ++i) {
        const auto trailer = call.read_frame();
        ASSERT_TRUE(trailer.has_value());
        first_id = i == 0 ? trailer->frame_id() : first_id;
        last_id = trailer->frame_id();
        EXPECT_TRUE(bystander_.gets_more_frames()); // meanwhile the channel goes on, however busy the machine is
        EXPECT_LE(served_.metric("fieldcast_bytes_in_flight{channel=\"synthetic\"}"),
                  session::kMaxCredits * (kFrameBytes + 36 * 1024)) // and those of the bystander, compressed
            << "what it has not read is bounded";
        call.acknowledge(*trailer);
    }
    EXPECT_GT(last_id - first_id, std::uint64_t{kFrames}) << "what it missed was not sent to it later";
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
    expect_closed_for("finished");
}

TEST_F(Hostile, AClientThatDoesNotReadIsCut) {
    OpenCall call(connect_with_small_window(served_.port()));
    call.configure(large_frames());
    ASSERT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    expect_closed_for("not_reading");
    EXPECT_FALSE(call.finish().ok());
}

TEST_F(Hostile, AClientThatNeverAcknowledgesIsSentAwayAndThenCut) {
    OpenCall call(connect(served_.port()));
    call.configure();
    const auto going_away = call.read_until(Kind::kGoingAway);
    ASSERT_TRUE(going_away.has_value());
    EXPECT_NE(going_away->going_away().reason().find("not acknowledged"), std::string::npos);
    EXPECT_EQ(call.finish().error_code(), StatusCode::DEADLINE_EXCEEDED) << "it does not half-close either";
    expect_closed_for("stalled");
}

TEST_F(Hostile, AClientThatNeverConfiguresIsSentAway) {
    OpenCall call(connect(served_.port()));
    EXPECT_TRUE(call.read_until(Kind::kGoingAway).has_value());
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
    expect_closed_for("not_configured");
}

TEST_F(Hostile, AClientThatFloodsIsCut) {
    OpenCall call(connect(served_.port()));
    call.configure();
    v1::FrameChunk nothing;
    nothing.set_epoch(77);
    while (call.acknowledge(nothing)) {
    }
    const grpc::Status status = call.finish();
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_NE(status.error_message().find("messages"), std::string::npos);
    expect_closed_for("flooding");
}

TEST_F(Hostile, AClientThatDropsItsConnectionIsForgotten) {
    auto connection = connect(served_.port());
    auto call = std::make_unique<OpenCall>(connection);
    call->configure();
    ASSERT_TRUE(call->read_until(Kind::kFrameChunk).has_value());
    call->cancel();
    call->finish();
    call.reset();
    connection.reset();
    expect_closed_for("cancelled");
}

TEST_F(Hostile, AConnectionThatNeverSpeaksIsClosed) {
    const HttpCaller silent("127.0.0.1", served_.port());
    std::array<char, 256> buffer{};
    ssize_t count = 1;
    while (count > 0) { // the server's own settings, then the end; -1 would be the caller's own patience of 20 s
        count = ::recv(silent.descriptor(), buffer.data(), buffer.size(), 0);
    }
    EXPECT_EQ(count, 0);
    EXPECT_TRUE(bystander_.gets_more_frames());
}

TEST_F(Hostile, AConnectionWithoutCallsIsClosed) {
    const auto connection = connect(served_.port());
    ASSERT_TRUE(connection->WaitForConnected(std::chrono::system_clock::now() + 10s));
    const auto deadline = Clock::now() + 10s;
    while (connection->GetState(false) == GRPC_CHANNEL_READY && Clock::now() < deadline) {
        std::this_thread::sleep_for(10ms);
    }
    EXPECT_NE(connection->GetState(false), GRPC_CHANNEL_READY);
    EXPECT_TRUE(bystander_.gets_more_frames());
}

TEST_F(Hostile, GarbageInsteadOfHttpIsClosed) {
    const std::string answer =
        http_get(served_.port(), "GET / HTTP/1.1\r\nHost: x\r\n\r\n" + std::string(4096, '\xFF'));
    EXPECT_EQ(answer.find("200"), std::string::npos);
    EXPECT_TRUE(bystander_.gets_more_frames());
}

TEST(HalfOpen, AClientBehindAPulledCableIsFoundByKeepalive) {
    session::Limits limits;
    limits.keepalive_interval = 300ms; // all other deadlines are 10 s and more
    limits.keepalive_timeout = 500ms;
    ServedChannel served(limits);
    Bystander bystander(served.port());
    Relay cable(served.port());
    OpenCall call(connect(cable.port()));
    call.configure();
    ASSERT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    const auto begin = Clock::now();
    cable.fall_silent();
    EXPECT_TRUE(served.shows(closed("cancelled"), 1));
    EXPECT_LT(Clock::now() - begin, 8s) << "before any other deadline";
    EXPECT_TRUE(bystander.gets_more_frames());
    call.cancel();
    call.finish();
}

} // namespace
} // namespace fieldcast::test
