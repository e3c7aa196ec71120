// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/backoff.h"

#include <chrono>
#include <stop_token>

namespace fieldcast::client::play {

/// Decides when to try again after a transient failure, and when to give up.
class Attempts {
public:
    /// Without `reconnects`, there is only one attempt. Gives up `patience` after the last success.
    Attempts(bool reconnects, std::chrono::milliseconds patience);

    /// Call it after a success: patience and delays start again.
    void succeeded();

    /// Waits before the next attempt. False if there must be none, or on a stop request.
    bool wait_for_next(const std::stop_token& stop, net::Obstacle obstacle);

private:
    bool reconnects_;
    std::chrono::milliseconds patience_;
    std::chrono::steady_clock::time_point gives_up_;
    net::Backoff backoff_;
};

} // namespace fieldcast::client::play
