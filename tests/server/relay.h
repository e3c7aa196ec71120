// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>

namespace fieldcast::test {

/// Passes on one TCP connection to a port of this machine, until it is told to fall silent: then both ends stay
/// connected and hear nothing any more, as behind a cable that was pulled.
class Relay {
public:
    explicit Relay(int target_port);
    ~Relay();
    Relay(const Relay&) = delete;
    Relay& operator=(const Relay&) = delete;

    int port() const { return port_; }
    void fall_silent() { is_silent_ = true; }

private:
    void pass_on(const std::stop_token& stop);

    int target_port_;
    int listening_;
    int port_ = 0;
    std::atomic<bool> is_silent_ = false;
    std::jthread thread_;
};

} // namespace fieldcast::test
