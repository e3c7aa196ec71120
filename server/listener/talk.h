// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/wakeup.h"

#include <stdexcept>
#include <string_view>

namespace fieldcast::listener {

/// Thrown if the other side does not answer; contains the reason.
class NoAnswer : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Waiting for one socket until a deadline.
class Patience {
public:
    Patience(const Wakeup& wakeup, int socket, std::chrono::milliseconds duration)
        : wakeup_(wakeup), socket_(socket), deadline_(std::chrono::steady_clock::now() + duration) {}

    /// Waits for `events` of poll(2). Throws NoAnswer at the deadline. False: the thread must stop.
    bool wait(short events) const;

private:
    const Wakeup& wakeup_;
    int socket_;
    std::chrono::steady_clock::time_point deadline_;
};

/// Sends and receives bytes over a connected non-blocking socket.
class Talk {
public:
    virtual ~Talk() = default;

    /// Receives at most `size` bytes; 0: nothing yet. Throws NoAnswer if the other side has closed the connection.
    virtual std::size_t read(char* into, std::size_t size) = 0;

    /// Sends bytes that fit the socket's buffer. Throws NoAnswer if they cannot be sent.
    virtual void write(std::string_view bytes) = 0;
};

} // namespace fieldcast::listener
