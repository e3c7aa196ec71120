// SPDX-License-Identifier: Apache-2.0
// Clients that misbehave: each is detected, counted by reason and closed, and a client that behaves notices nothing.
#include "server/session/credits.h"
#include "tests/fixtures/http_client.h"
#include "tests/server/relay.h"
#include "tests/server/served_channel.h"
#include "tests/server/session_count.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using Kind = v1::ServerMessage;

std::string closed(const char* reason) {
    return "fieldcast_sessions_closed_total{reason=\"" + std::string(reason) + "\"}";
}

/// Short enough to wait for, and long enough for a bystander on a busy machine. Each test shortens the one deadline that
/// it is about: the bystander keeps to that one only.
constexpr auto kShort = 2s;

class Hostile : public testing::Test {
protected:
    void serve(const session::Limits& limits = {}) {
        served_.emplace(limits);
        bystander_.emplace(served_->port());
        ASSERT_TRUE(bystander_->gets_more_frames());
    }
    int port() const { return served_->port(); }

    /// That one session was closed for `reason`, nobody but the bystander is left, and the bystander notices nothing.
    void expect_closed_for(const char* reason) {
        EXPECT_TRUE(served_->shows(closed(reason), 1));
        EXPECT_TRUE(test::comes_to_sessions(served_->server(), 1));
        EXPECT_TRUE(bystander_->gets_more_frames());
    }

    /// 36 views of 7 KB each: more than a small window.
    static v1::Configure large_frames() {
        v1::Configure wanted;
        v1::CodecPreference& preference = *wanted.add_codecs();
        preference.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
        preference.add_codecs(v1::CODEC_RAW);
        return wanted;
    }

    std::optional<ServedChannel> served_;
    std::optional<Bystander> bystander_;
};

TEST_F(Hostile, ASlowReaderCostsItsCreditsAndGetsTheNewestFrames) {
    serve();
    constexpr double kFrameBytes = 36 * (64.0 * 36 * 3 + 1024); // payload, and more than the strips' headers need
    constexpr int kFrames = 6;
    OpenCall call(connect_with_small_window(port()));
    call.configure(large_frames());
    std::uint64_t first_id = 0;
    std::uint64_t last_id = 0;
    for (int i = 0; i < kFrames; ++i) {
        const auto trailer = call.read_frame();
        ASSERT_TRUE(trailer.has_value());
        first_id = i == 0 ? trailer->frame_id() : first_id;
        last_id = trailer->frame_id();
        EXPECT_TRUE(bystander_->gets_more_frames()); // meanwhile the channel goes on, however busy the machine is
        EXPECT_LE(served_->metric("fieldcast_bytes_in_flight{channel=\"synthetic\"}"),
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
    serve({.stall_deadline = kShort});
    OpenCall call(connect_with_small_window(port()));
    call.configure(large_frames());
    ASSERT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    expect_closed_for("not_reading");
    EXPECT_FALSE(call.finish().ok());
}

TEST_F(Hostile, AClientThatNeverAcknowledgesIsSentAwayAndThenCut) {
    serve({.stall_deadline = kShort, .going_away_deadline = 300ms});
    OpenCall call(connect(port()));
    call.configure();
    const auto going_away = call.read_until(Kind::kGoingAway);
    ASSERT_TRUE(going_away.has_value());
    EXPECT_NE(going_away->going_away().reason().find("not acknowledged"), std::string::npos);
    EXPECT_EQ(call.finish().error_code(), StatusCode::DEADLINE_EXCEEDED) << "it does not half-close either";
    expect_closed_for("stalled");
}

TEST_F(Hostile, AClientThatNeverConfiguresIsSentAway) {
    serve({.configure_deadline = kShort});
    OpenCall call(connect(port()));
    EXPECT_TRUE(call.read_until(Kind::kGoingAway).has_value());
    call.half_close();
    EXPECT_TRUE(call.finish().ok());
    expect_closed_for("not_configured");
}

TEST_F(Hostile, AClientThatFloodsIsCut) {
    serve({.max_messages_per_second = 300.0}); // thrice what a bystander acknowledges
    OpenCall call(connect(port()));
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
    serve();
    auto connection = connect(port());
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
    serve({.handshake_deadline = kShort});
    const HttpCaller silent("127.0.0.1", port());
    std::array<char, 256> buffer{};
    ssize_t count = 1;
    while (count > 0) { // the server's own settings, then the end; -1 would be the caller's own patience of 20 s
        count = ::recv(silent.descriptor(), buffer.data(), buffer.size(), 0);
    }
    EXPECT_EQ(count, 0);
    EXPECT_TRUE(bystander_->gets_more_frames());
}

TEST_F(Hostile, AConnectionWithoutCallsIsClosed) {
    serve({.idle_deadline = kShort});
    const auto connection = connect(port());
    ASSERT_TRUE(connection->WaitForConnected(std::chrono::system_clock::now() + kCallDeadline));
    EXPECT_TRUE(connection->WaitForStateChange(GRPC_CHANNEL_READY, std::chrono::system_clock::now() + kCallDeadline));
    EXPECT_TRUE(bystander_->gets_more_frames());
}

TEST_F(Hostile, GarbageInsteadOfHttpIsClosed) {
    serve();
    const std::string answer =
        http_get(port(), "GET / HTTP/1.1\r\nHost: x\r\n\r\n" + std::string(4096, '\xFF'));
    EXPECT_EQ(answer.find("200"), std::string::npos);
    EXPECT_TRUE(bystander_->gets_more_frames());
}

TEST(HalfOpen, AClientBehindAPulledCableIsFoundByKeepalive) {
    session::Limits limits;
    limits.keepalive_interval = 1s;
    limits.keepalive_timeout = 2s;
    limits.stall_deadline = 10min; // no other deadline can be what finds it
    ServedChannel served(limits);
    Bystander bystander(served.port());
    Relay cable(served.port());
    OpenCall call(connect(cable.port()));
    call.configure();
    ASSERT_TRUE(call.read_until(Kind::kFrameChunk).has_value());
    cable.fall_silent();
    EXPECT_TRUE(served.shows(closed("cancelled"), 1));
    EXPECT_TRUE(bystander.gets_more_frames());
    call.cancel();
    call.finish();
}

} // namespace
} // namespace fieldcast::test
