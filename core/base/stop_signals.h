// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace fieldcast {

/// Waits for SIGTERM and SIGINT instead of handling them asynchronously. Construct the only one of a process before any
/// thread is started, because threads inherit the signal mask. Threads that libraries started even earlier do not block
/// the signals; signals that they receive are forwarded to the waiting thread.
class StopSignals {
public:
    StopSignals();
    ~StopSignals(); ///< the signals stay blocked
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    /// True if a signal arrived, false if none did within `timeout`. Call it from one thread only, and not after that
    /// thread has ended.
    bool wait(std::chrono::milliseconds timeout) const;
};

} // namespace fieldcast
