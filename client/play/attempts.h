// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/backoff.h"

#include <chrono>
#include <stop_token>

namespace fieldcast::client::play {

/// When to try again after a transient failure, and when to give up.
class Attempts {
public:
    /// Without `reconnects` there is one attempt. Gives up when nothing has worked for `patience`.
    Attempts(bool reconnects, std::chrono::milliseconds patience);

    /// Something worked: patience and waiting times start anew.
    void succeeded();

    /// Waits before the next attempt. False if there is to be none, or on a stop request.
    bool wait_for_next(const std::stop_token& stop, net::Obstacle obstacle);

private:
    bool reconnects_;
    std::chrono::milliseconds patience_;
    std::chrono::steady_clock::time_point gives_up_;
    net::Backoff backoff_;
};

} // namespace fieldcast::client::play
