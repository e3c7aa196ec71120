// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/descriptor.h"

#include <chrono>
#include <cstdint>
#include <poll.h>
#include <span>

namespace fieldcast::listener {

/// Lets a thread wait for descriptors and for its stop at the same time. Made before the thread: it takes a descriptor.
class Wakeup {
public:
    /// Throws std::system_error.
    Wakeup();

    enum class Outcome : std::uint8_t { kReady, kLate, kStopped };

    /// Until one of `entries` is ready, `patience` has passed (negative: never), or somebody has called stop().
    Outcome wait(std::span<pollfd> entries, std::chrono::milliseconds patience) const;

    /// Ends every wait from now on. From any thread.
    void stop() const;

private:
    Descriptor event_;
};

} // namespace fieldcast::listener
