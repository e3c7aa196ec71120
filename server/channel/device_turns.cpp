// SPDX-License-Identifier: Apache-2.0
#include "server/channel/device_turns.h"

namespace fieldcast::channel {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::hours kUntilSomebodyActs{24};

} // namespace

DeviceTurn::~DeviceTurn() {
    if (turns_ != nullptr) {
        turns_->turns_.lock()->end(id_, Clock::now());
        turns_->changed_.notify_all();
    }
}

DevicePlace::~DevicePlace() {
    turns_.turns_.lock()->leave(id_);
    turns_.changed_.notify_all();
}

std::optional<DeviceTurn> DevicePlace::wait(const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] {
        { auto turns = turns_.turns_.lock(); } // keeps the wake-up out of the gap between a waiter's test and its sleep
        turns_.changed_.notify_all();
    });
    auto turns = turns_.turns_.lock();
    turns->want(id_);
    turns_.changed_.notify_all(); // another channel may be waiting for this one to come back
    while (!stop.stop_requested() && !turns->may_begin(id_, Clock::now())) {
        const auto now = Clock::now();
        const auto until = turns->ask_again(id_, now).value_or(now + kUntilSomebodyActs);
        turns.wait_until(turns_.changed_, until, [&, was_woken = false](const FairTurns&) mutable {
            return std::exchange(was_woken, true); // false at the first call, so that it sleeps; true after a wake-up
        });
    }
    if (stop.stop_requested()) {
        turns->give_up(id_);
        return std::nullopt;
    }
    turns->begin(id_, Clock::now());
    return DeviceTurn(turns_, id_);
}

} // namespace fieldcast::channel
