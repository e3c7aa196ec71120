// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/descriptor.h"

#include <chrono>
#include <cstdint>
#include <poll.h>
#include <span>

namespace fieldcast::listener {

/// Waits for descriptors and for a stop request at the same time. Construct it before the thread: it needs a
/// descriptor.
class Wakeup {
public:
    /// Throws std::system_error.
    Wakeup();

    enum class Outcome : std::uint8_t { kReady, kLate, kStopped };

    /// Waits until one of `entries` is ready, `patience` has passed (negative: no limit), or stop() was called.
    Outcome wait(std::span<pollfd> entries, std::chrono::milliseconds patience) const;

    /// Ends the current and all later waits. Thread-safe.
    void stop() const;

private:
    Descriptor event_;
};

} // namespace fieldcast::listener
