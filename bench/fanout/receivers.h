// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/fanout/message_loop.h"

#include <chrono>
#include <memory>

namespace fieldcast::bench::fanout {

/// Clients of LightField.Open, each with a connection of its own, that ask for what the channel has, count what comes
/// and acknowledge frames. They read no payload: a message is parsed only if it is small. All of it runs in gRPC's
/// threads.
class Receivers {
public:
    /// To a port of this machine, in plain text.
    Receivers(int port, std::size_t count);
    ~Receivers(); ///< cancels
    Receivers(const Receivers&) = delete;
    Receivers& operator=(const Receivers&) = delete;

    /// Waits until every client has got so many frames. Throws std::runtime_error with what a client was told instead.
    void wait_for_frames(std::uint64_t count, std::chrono::seconds patience);

    std::uint64_t bytes() const; ///< of all messages that came so far, to all clients
    std::uint64_t frames() const;

    /// The next `count` frames that the first client gets.
    MessageLoop capture(std::size_t count, std::chrono::seconds patience);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::bench::fanout
