// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/descriptor.h"

#include <chrono>
#include <poll.h>
#include <span>
#include <stop_token>

namespace fieldcast::listener {

/// Lets a thread wait for descriptors and for its stop at the same time.
class Wakeup {
public:
    /// Throws std::system_error.
    explicit Wakeup(const std::stop_token& stop);

    enum class Outcome : std::uint8_t { kReady, kLate, kStopped };

    /// Until one of `entries` is ready, `patience` has passed (negative: never), or the stop.
    Outcome wait(std::span<pollfd> entries, std::chrono::milliseconds patience) const;

private:
    struct Ring {
        int number;
        void operator()() const;
    };

    std::stop_token stop_;
    Descriptor event_;
    std::stop_callback<Ring> on_stop_;
};

} // namespace fieldcast::listener
