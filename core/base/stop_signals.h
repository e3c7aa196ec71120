// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace fieldcast {

/// TERM and INT, waited for instead of handled. Make the only one of a process before any thread is started: threads
/// inherit the mask. Threads of libraries that exist even before do not; what they are given is passed on.
class StopSignals {
public:
    StopSignals();
    ~StopSignals(); ///< the signals stay blocked
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    /// True: one arrived; false: none within `timeout`. Call it in one thread only, and not after that has ended.
    bool wait(std::chrono::milliseconds timeout) const;
};

} // namespace fieldcast
