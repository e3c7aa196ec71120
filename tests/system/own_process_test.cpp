// SPDX-License-Identifier: Apache-2.0
// A server whose clients have a camera each: they see different things at the same moment, and no more of them than
// fit.
#include "running_server.h"
#include "tests/server/server_client.h"

#include <cmath>
#include <cstdio>
#include <gmock/gmock.h>
#include <thread>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using Kind = v1::ServerMessage;
using testing::HasSubstr;

constexpr auto kPatience = 240s; // a software device on a busy machine

/// Looks at one place and gets the frames that show it.
class Visitor {
public:
    explicit Visitor(int port) : call_(connect(port), "", kPatience) {}

    v1::ServerMessage configure() {
        v1::Configure wanted;
        wanted.set_max_frames_per_second(1.0F);
        wanted.mutable_grid()->set_rows(1);
        wanted.mutable_grid()->set_cols(1);
        *wanted.add_codecs() = raw_colour();
        call_.configure(wanted);
        auto message = read();
        while (message && !message->has_configured() && !message->has_refused()) {
            message = read();
        }
        return message.value_or(Kind{});
    }

    /// Jumps to that height and looks along -Z: the first frame that shows it.
    std::string look_from(float metres) {
        v1::ClientMessage message;
        v1::SteerCamera& steer = *message.mutable_steer_camera();
        for (const float value : {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, metres, 3.0F}) {
            steer.add_world_from_camera(value);
        }
        steer.set_sequence(++sequence_);
        steer.set_cut(true);
        call_.send(message);
        return frame_of_pose(metres);
    }

    void request_steering() {
        v1::ClientMessage request;
        request.mutable_request_steering();
        call_.send(request);
        auto message = read();
        while (message && !message->has_steering_granted()) {
            message = read();
        }
        EXPECT_TRUE(message.has_value());
    }

    void leave() {
        call_.half_close();
        EXPECT_TRUE(call_.finish().ok());
    }

private:
    static v1::CodecPreference raw_colour() {
        v1::CodecPreference preference;
        preference.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
        preference.add_codecs(v1::CODEC_RAW);
        return preference;
    }

    /// The next message; frames are acknowledged.
    std::optional<v1::ServerMessage> read() {
        auto message = call_.read();
        if (message && message->frame_chunk().has_trailer()) {
            call_.acknowledge(message->frame_chunk());
        }
        return message;
    }

    /// Its bytes; empty if the stream ends before it comes.
    std::string frame_of_pose(float height_m) {
        std::string bytes;
        bool shows_pose = false;
        for (auto message = read(); message; message = read()) {
            const v1::FrameChunk& chunk = message->frame_chunk();
            if (chunk.has_header()) {
                bytes.clear();
                shows_pose = chunk.header().applied_pose().sequence() == sequence_;
                EXPECT_TRUE(!shows_pose || chunk.header().source().world_from_camera(10) == height_m);
            }
            bytes += chunk.payload();
            if (chunk.has_trailer() && shows_pose) {
                return bytes;
            }
        }
        return "";
    }

    OpenCall call_;
    std::uint64_t sequence_ = 0;
};

/// Mean absolute difference of bytes, 0 to 255.
double difference(const std::string& a, const std::string& b) {
    EXPECT_EQ(a.size(), b.size());
    EXPECT_FALSE(a.empty());
    double sum = 0.0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        sum += std::abs(static_cast<int>(static_cast<unsigned char>(a[i])) - static_cast<unsigned char>(b[i]));
    }
    return sum / static_cast<double>(std::max<std::size_t>(a.size(), 1));
}

TEST(OwnCameras, TwoClientsSeeDifferentThingsAndAThirdIsRefused) {
    RunningServer server(FIELDCAST_SERVER, {"--camera-control", "own", "--max-own-cameras", "2", "--max-own-cameras-per-peer", "2", "--own-camera-budget",
                                            "1000000", "--guard-band", "none", "--time", "0"});
    if (server.lacks_device()) {
        GTEST_SKIP() << server.log();
    }
    Visitor low(server.port());
    Visitor high(server.port());
    ASSERT_TRUE(low.configure().has_configured()) << server.log();
    ASSERT_TRUE(high.configure().has_configured()) << server.log();
    EXPECT_EQ(server.metric("fieldcast_own_cameras{channel=\"atelier\"}"), 2.0);
    Visitor third(server.port());
    EXPECT_THAT(third.configure().refused().message(), HasSubstr("all 2"));
    third.leave();
    std::string below;
    std::string above;
    std::string same;
    {
        const std::jthread beside([&] {
            low.request_steering();
            below = low.look_from(1.0F);
            low.leave();
        });
        high.request_steering(); // while the other one steers
        above = high.look_from(2.0F);
        same = high.look_from(1.0F);
        high.leave();
    }
    const double noise = difference(below, same); // of one sample per pixel, filtered: the frames' numbers differ
    std::printf("noise %.2f, a metre higher %.2f\n", noise, difference(below, above));
    EXPECT_GT(difference(below, above), 2.0 * noise);
    EXPECT_GT(difference(below, above), 4.0) << "of 255";
    EXPECT_TRUE(server.shows("fieldcast_own_cameras{channel=\"atelier\"}", 0.0, kPatience)) << server.log();
    Visitor next(server.port());
    EXPECT_TRUE(next.configure().has_configured()) << "there is room again";
    next.leave();
    server.process().send_signal(SIGTERM);
    EXPECT_EQ(server.process().exit_code(kPatience), 0) << server.log();
}

} // namespace
} // namespace fieldcast::test
