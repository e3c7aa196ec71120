// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace fieldcast::ops {

/// TERM and INT, waited for instead of handled. Make it before any thread is started: threads inherit the mask.
class StopSignals {
public:
    StopSignals();

    /// True: one arrived; false: none within `timeout`.
    bool wait(std::chrono::milliseconds timeout) const;
};

} // namespace fieldcast::ops
