// SPDX-License-Identifier: Apache-2.0
// Channels that share a device: who gets how much of it, on a simulated clock and with threads.
#include "server/channel/device_turns.h"
#include "tests/server/frame_time.h"

#include <array>
#include <atomic>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

namespace fieldcast::channel {
namespace {

using namespace std::chrono_literals;
using Duration = FairTurns::Duration;
using TimePoint = FairTurns::TimePoint;

/// A channel that uses the device for `cost`, stays away for `away`, and comes again.
struct Worker {
    Duration cost{};
    Duration away{};
    TimePoint comes{};
    Duration used{};
    int turns = 0;
    FairTurns::Id id = 0;
    bool is_waiting = false;
};

/// Jain's index of the time that they have had; 1: all the same.
double fairness(const std::vector<Worker>& workers) {
    double sum = 0.0;
    double squares = 0.0;
    for (const Worker& worker : workers) {
        const double used = std::chrono::duration<double>(worker.used).count();
        sum += used;
        squares += used * used;
    }
    return sum * sum / (static_cast<double>(workers.size()) * squares);
}

/// Lets them work for `length`; the share of it in which the device was used.
double simulate(std::vector<Worker>& workers, Duration length) {
    FairTurns turns;
    for (Worker& worker : workers) {
        worker.id = turns.join();
    }
    const TimePoint start{1h};
    Duration used{};
    for (TimePoint now = start; now < start + length;) {
        TimePoint next = now + 100us; // the clock's step, far below all costs
        for (Worker& worker : workers) {
            if (!worker.is_waiting && worker.comes <= now) {
                worker.is_waiting = true;
                turns.want(worker.id);
            }
        }
        for (Worker& worker : workers) {
            if (worker.is_waiting && turns.may_begin(worker.id, now)) {
                turns.begin(worker.id, now);
                next = now + worker.cost;
                turns.end(worker.id, next);
                worker.is_waiting = false;
                worker.comes = next + worker.away;
                worker.used += worker.cost;
                used += worker.cost;
                ++worker.turns;
                break;
            }
        }
        now = next;
    }
    return std::chrono::duration<double>(used) / std::chrono::duration<double>(length);
}

TEST(FairTurns, ExpensiveAndCheapGetTheSameTime) {
    std::vector<Worker> workers{{.cost = 40ms, .away = 1ms}, {.cost = 10ms, .away = 1ms}};
    const double use = simulate(workers, 20s);
    EXPECT_GT(fairness(workers), 0.999); // turns one after the other would give 0.735
    EXPECT_NEAR(workers[1].turns, 4 * workers[0].turns, 8) << "four cheap ones for an expensive one";
    EXPECT_GT(use, 0.9) << "the device waits a millisecond after each cheap turn";
}

TEST(FairTurns, ThreeOfDifferentCostShareToo) {
    std::vector<Worker> workers{{.cost = 80ms, .away = 1ms}, {.cost = 10ms, .away = 1ms}, {.cost = 5ms, .away = 0ms}};
    simulate(workers, 60s);
    EXPECT_GT(fairness(workers), 0.99);
}

TEST(FairTurns, WhoWantsLittleLeavesTheRest) {
    // 10 ms of every 110 for the cheap one, which does not want more.
    std::vector<Worker> workers{{.cost = 40ms, .away = 0ms}, {.cost = 10ms, .away = 100ms}};
    const double use = simulate(workers, 20s);
    EXPECT_GT(use, 0.94) << "the device waits for it an eighth of 40 ms at most, once a turn of it";
    EXPECT_GT(workers[1].turns, 20'000 / (110 + 45)) << "and it waits for one turn of the other at most";
}

TEST(FairTurns, BeingAwaySavesNothingUp) {
    FairTurns turns;
    const auto busy = turns.join();
    const auto guest = turns.join();
    TimePoint now{1h};
    const auto work = [&](FairTurns::Id id, Duration cost) {
        turns.want(id);
        now += 10ms; // more than anybody's patience
        ASSERT_TRUE(turns.may_begin(id, now));
        turns.begin(id, now);
        now += cost;
        turns.end(id, now);
    };
    work(guest, 10ms);
    for (int i = 0; i < 100; ++i) {
        work(busy, 10ms);
    }
    work(guest, 10ms); // after a second's absence
    work(guest, 10ms);
    turns.want(guest);
    turns.want(busy);
    EXPECT_FALSE(turns.may_begin(guest, now + 10ms)) << "it has had more, since it came back";
    EXPECT_TRUE(turns.may_begin(busy, now + 10ms));
}

TEST(FairTurns, OneAloneNeverWaits) {
    std::vector<Worker> workers{{.cost = 10ms, .away = 0ms}};
    EXPECT_GT(simulate(workers, 1s), 0.999);
}

TEST(DeviceTurns, OneAtATimeWithThreadsAndStops) {
    DeviceTurns turns;
    std::atomic<int> inside = 0;
    std::atomic<int> most = 0;
    Guarded<std::array<int, 2>> counts;
    std::condition_variable counted;
    const auto enough = [](const std::array<int, 2>& each) { return each[0] >= 5 && each[1] >= 5; };
    const auto work = [&](const std::stop_token& stop, std::size_t index, Duration cost) {
        DevicePlace place(turns);
        while (const auto turn = place.wait(stop)) {
            most = std::max(most.load(), ++inside);
            test::pass_frame_time(cost);
            --inside;
            ++counts.lock()->at(index);
            counted.notify_all();
        }
    };
    {
        std::jthread slow([&](const std::stop_token& stop) { work(stop, 0, 8ms); });
        std::jthread fast([&](const std::stop_token& stop) { work(stop, 1, 2ms); });
        EXPECT_TRUE(counts.lock().wait_until(counted, std::chrono::steady_clock::now() + 20s, enough));
    } // stops both, whoever waits
    EXPECT_EQ(most, 1);
}

} // namespace
} // namespace fieldcast::channel
