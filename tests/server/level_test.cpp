// SPDX-License-Identifier: Apache-2.0
// How the server fits a session to its connection: the controller of levels and the meter, on simulated links.
#include "server/session/server_session.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <gtest/gtest.h>
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

} // namespace
} // namespace fieldcast::session
