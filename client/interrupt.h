// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/stop_signals.h"

#include <stop_token>
#include <thread>

namespace fieldcast::client {

/// Exit codes of fieldcast-client and fieldcast-load.
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUserError = 2;
inline constexpr int kExitInterrupted = 130;

/// Turns the first SIGINT or SIGTERM into a stop request; the second one ends the process at once with exit code 130.
/// Must be constructed before any other thread: later threads inherit the blocked signals, so only this one sees them.
class Interrupt {
public:
    Interrupt();

    std::stop_token token() const { return source_.get_token(); }
    bool was_requested() const { return source_.stop_requested(); }

private:
    void listen(const std::stop_token& stop);

    StopSignals signals_;
    std::stop_source source_;
    std::jthread thread_;
};

} // namespace fieldcast::client
