// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/fanout/message_loop.h"

#include <chrono>
#include <memory>

namespace fieldcast::bench::fanout {

/// Clients of LightField.Open, each with a connection of its own. They request the channel's own configuration, count
/// received bytes and acknowledge frames. They do not read payloads: only small messages are parsed. All of it runs in
/// gRPC's threads.
class Receivers {
public:
    /// Connects to a port of this machine in plain text.
    Receivers(int port, std::size_t count);
    ~Receivers(); ///< cancels all calls
    Receivers(const Receivers&) = delete;
    Receivers& operator=(const Receivers&) = delete;

    /// Waits until every client has received `count` frames. Throws std::runtime_error with the server's error.
    void wait_for_frames(std::uint64_t count, std::chrono::seconds patience);

    std::uint64_t bytes() const; ///< bytes of all messages received so far by all clients
    std::uint64_t frames() const;

    /// The next `count` frames that the first client receives.
    MessageLoop capture(std::size_t count, std::chrono::seconds patience);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::bench::fanout
