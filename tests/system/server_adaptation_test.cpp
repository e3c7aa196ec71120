// SPDX-License-Identifier: Apache-2.0
// How the server fits a session to its connection: the controller on simulated links, the ladder, and the session.
#include "server/session/session.h"
#include "server_synthetic.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <gmock/gmock.h>
#include <random>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;


constexpr double kMbit = 1e6 / 8.0; // bytes per second

/// A connection with a queue in front of it, as routers have.
struct Link {
    std::function<double(double)> megabits = [](double /*seconds*/) { return 1000.0; };
    double round_trip_ms = 10.0;
    double jitter_ms = 0.0;        ///< ±, uniform
    double retransmissions = 0.0;  ///< share of frames that lose a packet and wait
    double retransmission_ms = 0.0;
};

/// A session at 30 frames per second on a link, with the credits that a session has; millisecond by millisecond.
class Simulation {
public:
    Simulation(Link link, double megabits_asked, std::vector<double> costs)
        : link_(std::move(link)), megabits_asked_(megabits_asked), costs_(std::move(costs)),
          controller_(costs_, 100ms) {}

    void run(int seconds) {
        for (int end = now_ms_ + 1000 * seconds; now_ms_ < end; ++now_ms_) {
            step();
        }
    }

    std::size_t level() const { return controller_.level(); }
    int changes() const { return changes_; }
    double needed_megabits() const { return megabits_asked_ * costs_[level()]; }
    double mean_delay_ms() const { return acknowledged_ == 0 ? 0.0 : delay_sum_ms_ / acknowledged_; }
    void forget_delays() { delay_sum_ms_ = acknowledged_ = 0; }

private:
    struct Frame {
        FrameKey key;
        double left_bytes = 0.0;
        double begun_ms = 0.0;
        double acknowledged_ms = 0.0;
    };

    TimePoint now() const { return TimePoint(milliseconds(now_ms_)); }

    void step() {
        constexpr double kInterval_ms = 1000.0 / 30.0;
        if (now_ms_ >= next_frame_ms_) {
            next_frame_ms_ += kInterval_ms;
            begin_frame(megabits_asked_ * kMbit * costs_[level()] / 30.0);
        }
        drain(link_.megabits(now_ms_ / 1000.0) * kMbit / 1000.0);
        while (!answered_.empty() && answered_.front().acknowledged_ms <= now_ms_) {
            acknowledge(answered_.front());
            answered_.pop_front();
        }
        if (const auto change = now_ms_ % 50 == 0 ? controller_.decide(now()) : std::nullopt) {
            ++changes_;
            ++epoch_;
        }
    }

    void begin_frame(double bytes) {
        const auto whole = static_cast<std::uint64_t>(bytes);
        if (!credits_.allow(whole)) {
            controller_.miss();
            return; // the newest waits, which is this one's successor
        }
        const FrameKey key{epoch_, ++frame_id_};
        credits_.spend(key, whole, now());
        credits_.sent(key, now());
        meter_.begun(key, whole, now());
        queue_.push_back({.key = key, .left_bytes = bytes, .begun_ms = static_cast<double>(now_ms_)});
    }

    void drain(double bytes) {
        while (!queue_.empty() && bytes > 0.0) {
            const double taken = std::min(bytes, queue_.front().left_bytes);
            bytes -= taken;
            queue_.front().left_bytes -= taken;
            if (queue_.front().left_bytes <= 0.0) {
                arrive(queue_.front());
                queue_.pop_front();
            }
        }
    }

    void arrive(Frame frame) {
        const auto draw = [&] { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); };
        const double jitter = link_.jitter_ms * (2.0 * draw() - 1.0);
        const double waits = draw() < link_.retransmissions ? link_.retransmission_ms : 0.0;
        const double before = answered_.empty() ? 0.0 : answered_.back().acknowledged_ms; // in order
        frame.acknowledged_ms = std::max(before, now_ms_ + link_.round_trip_ms + jitter + waits);
        answered_.push_back(frame);
    }

    void acknowledge(const Frame& frame) {
        credits_.acknowledged(frame.key, 0ms, now());
        delay_sum_ms_ += now_ms_ - frame.begun_ms;
        ++acknowledged_;
        if (const auto sample = meter_.acknowledged(frame.key, 0ms, now()); sample && frame.key.epoch == epoch_) {
            controller_.add(*sample, now());
        }
    }

    Link link_;
    double megabits_asked_;
    std::vector<double> costs_;
    LevelController controller_;
    LinkMeter meter_;
    Credits credits_{30.0, 1U << 30U};
    std::mt19937 random_{7};
    std::deque<Frame> queue_;    ///< not yet through the link
    std::deque<Frame> answered_; ///< on their way back
    int now_ms_ = 0;
    double next_frame_ms_ = 0.0;
    std::uint64_t frame_id_ = 0;
    std::uint32_t epoch_ = 1;
    int changes_ = 0;
    double delay_sum_ms_ = 0.0;
    double acknowledged_ = 0.0;
};

const std::vector<double> kCosts{1.0, 0.5, 0.3, 0.2, 0.1, 0.05, 0.02};

TEST(LevelController, LeavesAGoodConnectionAlone) {
    Simulation simulation({}, 80.0, kCosts);
    simulation.run(120);
    EXPECT_EQ(simulation.changes(), 0);
}

TEST(LevelController, JitterIsNoQueue) {
    Simulation simulation({.megabits = [](double) { return 100.0; }, .round_trip_ms = 100.0, .jitter_ms = 40.0}, 40.0,
                          kCosts); // 50 ± 20 ms each way
    simulation.run(120);
    EXPECT_EQ(simulation.changes(), 0);
}

TEST(LevelController, LossIsNoQueue) {
    Simulation simulation({.megabits = [](double) { return 100.0; },
                           .round_trip_ms = 40.0,
                           .jitter_ms = 5.0,
                           .retransmissions = 0.05, // frames of five packets, a hundredth of them lost
                           .retransmission_ms = 200.0},
                          10.0, kCosts);
    simulation.run(120);
    EXPECT_EQ(simulation.changes(), 0) << "a lost packet delays a few frames, not all of half a second";
}

TEST(LevelController, SettlesOnANarrowConnection) {
    Simulation simulation({.megabits = [](double) { return 20.0; }, .round_trip_ms = 20.0}, 80.0, kCosts);
    simulation.run(5);
    EXPECT_LT(simulation.needed_megabits(), 20.0) << "within five seconds";
    simulation.run(55);
    simulation.forget_delays();
    const int before = simulation.changes();
    simulation.run(120);
    EXPECT_LE(simulation.changes() - before, 8) << "tries again after 20, 40, 80 … s, once up and once down each";
    EXPECT_GE(simulation.needed_megabits(), 8.0) << "and does not sit far below what fits";
    EXPECT_LT(simulation.mean_delay_ms(), 20.0 + 100.0) << "round trip and bound";
}

TEST(LevelController, FollowsAStepDownAndBack) {
    const auto capacity = [](double seconds) { return seconds >= 20.0 && seconds < 80.0 ? 5.0 : 100.0; };
    Simulation simulation({.megabits = capacity, .round_trip_ms = 20.0}, 40.0, kCosts);
    simulation.run(20);
    EXPECT_EQ(simulation.changes(), 0);
    simulation.run(8);
    EXPECT_LT(simulation.needed_megabits(), 5.0) << "eight seconds after the step from 100 to 5 Mbit/s";
    simulation.run(52);
    const int during = simulation.changes();
    EXPECT_LE(during, 12);
    simulation.run(180);
    EXPECT_EQ(simulation.level(), 0U) << "as asked for, three minutes after the connection recovered at the latest";
    const int after = simulation.changes();
    simulation.run(120);
    EXPECT_EQ(simulation.changes(), after) << "and stays there";
}

TEST(LevelController, ARefusedStepIsPassedOver) {
    LevelController controller({1.0, 0.9, 0.1}, 100ms);
    const auto overload = [&](int at_ms) {
        for (int i = 0; i < 3; ++i) {
            controller.add({.bytes = 1000, .queue_delay = 101ms}, TimePoint(milliseconds(at_ms + 300 * i)));
        }
        return controller.decide(TimePoint(milliseconds(at_ms + 600)));
    };
    const auto first = overload(0);
    ASSERT_TRUE(first);
    controller.refused();
    EXPECT_EQ(controller.level(), 0U);
    const auto second = overload(1000);
    ASSERT_TRUE(second);
    EXPECT_NE(second->level, first->level);
}

TEST(LinkMeter, FramesBehindAnOlderEpochSayNothing) {
    LinkMeter meter;
    const TimePoint start{};
    meter.begun({1, 1}, 10, start);
    meter.begun({2, 2}, 10, start + 1ms); // waits for what epoch 1 left
    EXPECT_TRUE(meter.acknowledged({1, 1}, 0ms, start + 50ms));
    EXPECT_FALSE(meter.acknowledged({2, 2}, 0ms, start + 60ms));
    meter.begun({2, 3}, 10, start + 70ms);
    const auto sample = meter.acknowledged({2, 3}, 5ms, start + 145ms);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->queue_delay, 20ms) << "70 ms on the way, and 50 ms are the smallest round trip";
    meter.add_round_trip(10ms, start + 150ms);
    EXPECT_EQ(meter.base_round_trip(), 10ms);
}

// The ladder.

v1::Configure adaptive(std::uint32_t side = 6) {
    v1::Configure wanted;
    wanted.set_request_id(7);
    wanted.mutable_grid()->set_rows(side);
    wanted.mutable_grid()->set_cols(side);
    v1::Adaptation& bounds = *wanted.mutable_adaptation();
    bounds.add_codecs(v1::CODEC_JPEG);
    bounds.set_min_quality(40);
    bounds.set_min_frames_per_second(25.0F);
    bounds.set_min_view_height_px(18);
    bounds.set_min_rows(3);
    bounds.set_min_cols(3);
    return wanted;
}

class AdaptationTest : public testing::Test {
protected:
    Ladder ladder(const v1::Configure& wanted) const {
        const std::vector<std::shared_ptr<feed::Feed>> channels{feed_};
        const auto granted = negotiate(wanted, channels, Limits{});
        EXPECT_TRUE(granted);
        return {wanted, *granted};
    }

    v1::ServerMessage next() {
        v1::ServerMessage message;
        if (const auto chunk = session_.next(now_)) {
            EXPECT_TRUE(message.ParseFromString(wire::joined(*chunk)));
        }
        return message;
    }

    void configure(const v1::Configure& wanted) {
        v1::ClientMessage message;
        *message.mutable_configure() = wanted;
        session_.on_message(message, now_);
        EXPECT_TRUE(next().has_configured());
    }

    /// One frame that is acknowledged after `on_the_way`; returns the Configured of a change, if one came.
    std::optional<v1::Configured> frame(milliseconds on_the_way) {
        std::optional<v1::Configured> changed;
        ++frame_id_;
        feed_->publish(test::synthetic_frame(feed_->info(), feed_->demand(now_), frame_id_, pool_, frame_id_), now_);
        for (v1::ServerMessage message = next(); message.message_case() != v1::ServerMessage::MESSAGE_NOT_SET;
             message = next()) {
            changed = message.has_configured() ? std::optional(message.configured()) : changed;
        }
        now_ += on_the_way;
        v1::ClientMessage message;
        message.mutable_frame_ack()->set_frame_id(frame_id_);
        message.mutable_frame_ack()->set_epoch(session_.epoch());
        message.mutable_frame_ack()->set_outcome(v1::FRAME_OUTCOME_DECODED);
        session_.on_message(message, now_);
        session_.on_tick(now_);
        return changed;
    }

    /// Frames until the server changes something.
    std::optional<v1::Configured> until_change(milliseconds on_the_way, int most_frames) {
        for (int i = 0; i < most_frames; ++i) {
            if (auto changed = frame(on_the_way)) {
                return changed;
            }
        }
        return std::nullopt;
    }

    std::shared_ptr<feed::Feed> feed_ = std::make_shared<feed::Feed>(test::synthetic_info());
    WorkerPool pool_{1};
    TimePoint now_{TimePoint::duration(1h)};
    std::uint64_t frame_id_ = 0;
    Session session_{{feed_}, Limits{}, [this](const feed::FramePtr& frame) { session_.on_frame(frame, now_); }, now_};
};

TEST_F(AdaptationTest, TheLadderGoesFromTheLeastPainfulOn) {
    v1::Configure wanted = adaptive();
    wanted.mutable_adaptation()->add_modes(v1::DELIVERY_MODE_SCENE);
    std::string changes;
    double cost = 2.0;
    const Ladder made = ladder(wanted);
    for (const Rung& rung : made.rungs()) {
        changes += made.change(rung) + "; ";
        EXPECT_LT(rung.cost, cost) << made.change(rung);
        cost = rung.cost;
        const std::vector<std::shared_ptr<feed::Feed>> channels{feed_};
        EXPECT_TRUE(negotiate(made.configure(rung), channels, Limits{})) << "every rung is a Configure that is granted";
    }
    EXPECT_EQ(changes, "as asked for; jpeg of quality 75; quality 55; quality 40; 1/2 of the frames; "
                       "1/4 of the frames; views of 43x24; views of 32x18; 5x5 views; 4x4 views; 3x3 views; ")
        << "two planes of 64x36 are more than nine views of 32x18, so that mode scene would not help";
}

TEST_F(AdaptationTest, BoundsHold) {
    v1::Configure wanted = adaptive();
    wanted.mutable_adaptation()->Clear();
    EXPECT_EQ(ladder(wanted).rungs().size(), 1U) << "nothing may change";
    wanted.mutable_adaptation()->set_min_quality(40);
    EXPECT_EQ(ladder(wanted).rungs().size(), 1U) << "lossless stays lossless unless JPEG is allowed";
    wanted.mutable_adaptation()->add_modes(v1::DELIVERY_MODE_SCENE);
    const Ladder made = ladder(wanted);
    ASSERT_EQ(made.rungs().size(), 2U) << "36 views are more than two planes";
    EXPECT_EQ(made.configure(made.rungs()[1]).modes(0), v1::DELIVERY_MODE_SCENE);
    EXPECT_EQ(made.configure(made.rungs()[1]).planes(), v1::PLANE_SET_ILLUMINATION);
}

TEST_F(AdaptationTest, EveryModeHasPlanesThatCanBecomeJpeg) {
    struct Mode {
        v1::DeliveryMode mode;
        std::vector<PlaneSemantic> pictures;
    };
    for (const Mode& mode : {Mode{v1::DELIVERY_MODE_VIEWS, {PlaneSemantic::kColour}},
                             Mode{v1::DELIVERY_MODE_SCENE, {PlaneSemantic::kDiffuse, PlaneSemantic::kSpecular}},
                             Mode{v1::DELIVERY_MODE_WARP, {PlaneSemantic::kColour, PlaneSemantic::kResidualColour}}}) {
        v1::Configure wanted = adaptive();
        wanted.add_modes(mode.mode);
        wanted.add_warp_planes(v1::WARP_PLANE_RESIDUAL);
        const Ladder made = ladder(wanted);
        ASSERT_GT(made.rungs().size(), 2U);
        for (const Rung& rung : made.rungs().subspan(1, 2)) {
            const std::vector<std::shared_ptr<feed::Feed>> channels{feed_};
            const v1::Configured got = to_message(*negotiate(made.configure(rung), channels, Limits{}), 1, 2, 2);
            std::vector<PlaneSemantic> lossy;
            for (const v1::PlaneHeader& plane : got.planes()) {
                if (plane.codec() == v1::CODEC_JPEG) {
                    EXPECT_EQ(plane.quality(), rung.quality);
                    lossy.push_back(*wire::from_proto(plane.semantic()));
                }
            }
            EXPECT_EQ(lossy, mode.pictures) << v1::DeliveryMode_Name(mode.mode);
        }
    }
}

TEST_F(AdaptationTest, TheLadderKeepsALossyCodecAndRaisesNoQuality) {
    v1::Configure wanted = adaptive();
    v1::CodecPreference& colour = *wanted.add_codecs();
    colour.set_semantic(v1::PLANE_SEMANTIC_COLOUR);
    colour.add_codecs(v1::CODEC_H264);
    colour.set_quality(55);
    const Ladder made = ladder(wanted);
    EXPECT_EQ(made.change(made.rungs()[1]), "quality 40");
    const v1::Configure next = made.configure(made.rungs()[1]);
    EXPECT_EQ(next.codecs(0).codecs(0), v1::CODEC_H264);
    EXPECT_EQ(next.codecs(0).quality(), 40U);
}

TEST_F(AdaptationTest, AWarpSessionOnANarrowConnectionGetsFewerBytes) {
    v1::Configure wanted = adaptive();
    wanted.add_modes(v1::DELIVERY_MODE_WARP);
    configure(wanted);
    frame(20ms);
    const std::uint64_t before = session_.counts().plane_bytes.begin()->second;
    until_change(20ms, 60);
    const auto down = until_change(400ms, 12);
    ASSERT_TRUE(down);
    EXPECT_EQ(down->planes(0).semantic(), v1::PLANE_SEMANTIC_COLOUR);
    EXPECT_EQ(down->planes(0).codec(), v1::CODEC_JPEG);
    frame(20ms);
    frame(20ms);
    std::uint64_t jpeg_bytes = 0;
    for (const auto& [choice, bytes] : session_.counts().plane_bytes) {
        jpeg_bytes += choice.encoding.codec == Codec::kJpeg ? bytes : 0;
    }
    EXPECT_GT(before, 0U);
    EXPECT_GT(jpeg_bytes, 0U) << "colour really comes as JPEG";
}

TEST_F(AdaptationTest, AQueueTakesTheSessionDownAndCalmBringsItBack) {
    configure(adaptive());
    EXPECT_FALSE(until_change(20ms, 60)) << "a good connection";
    const auto down = until_change(400ms, 12);
    ASSERT_TRUE(down);
    EXPECT_EQ(down->request_id(), 7U);
    EXPECT_EQ(down->epoch(), 2U);
    EXPECT_EQ(down->adapted().reason(), v1::ADAPTATION_REASON_QUEUE_DELAY);
    EXPECT_GE(down->adapted().level(), 1U);
    EXPECT_GE(down->adapted().queue_delay_ms(), 300U);
    EXPECT_GT(down->adapted().delivered_bytes_per_second(), 0U);
    EXPECT_EQ(down->planes(0).codec(), v1::CODEC_JPEG);
    EXPECT_EQ(session_.adapted_level(), down->adapted().level());
    EXPECT_EQ(session_.counts().adaptations.down, 1U);
    const auto up = until_change(20ms, 400); // five seconds of calm, eight of patience
    ASSERT_TRUE(up);
    EXPECT_EQ(up->adapted().reason(), v1::ADAPTATION_REASON_RECOVERED);
    EXPECT_EQ(up->adapted().level(), down->adapted().level() - 1);
    EXPECT_EQ(up->epoch(), 3U);
    EXPECT_EQ(session_.counts().adaptations.up, 1U);
}

TEST_F(AdaptationTest, WhoDoesNotAllowItKeepsWhatWasGranted) {
    v1::Configure wanted = adaptive();
    wanted.clear_adaptation();
    configure(wanted);
    until_change(20ms, 30);
    EXPECT_FALSE(until_change(500ms, 30));
    EXPECT_EQ(session_.epoch(), 1U);
}

TEST_F(AdaptationTest, AnotherRequestStartsAtItsOwnTop) {
    configure(adaptive());
    until_change(20ms, 30);
    ASSERT_TRUE(until_change(400ms, 12));
    v1::Configure wanted = adaptive(4);
    wanted.set_request_id(8);
    v1::ClientMessage message;
    *message.mutable_configure() = wanted;
    session_.on_message(message, now_);
    EXPECT_EQ(session_.adapted_level(), 0U);
    v1::ServerMessage answer = next();
    while (!answer.has_configured()) {
        answer = next();
    }
    EXPECT_EQ(answer.configured().request_id(), 8U);
    EXPECT_FALSE(answer.configured().has_adapted());
    EXPECT_EQ(answer.configured().planes(0).codec(), v1::CODEC_ZSTD_FILTERED);
}

} // namespace
} // namespace fieldcast::session
