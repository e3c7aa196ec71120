// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/listener/wakeup.h"

#include <stdexcept>
#include <string_view>

namespace fieldcast::listener {

/// Why the other side did not answer.
class NoAnswer : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Waiting for one socket until a deadline.
class Patience {
public:
    Patience(const Wakeup& wakeup, int socket, std::chrono::milliseconds duration)
        : wakeup_(wakeup), socket_(socket), deadline_(std::chrono::steady_clock::now() + duration) {}

    /// Until `events` of poll(2). Throws NoAnswer at the deadline. False: the thread has to stop.
    bool wait(short events) const;

private:
    const Wakeup& wakeup_;
    int socket_;
    std::chrono::steady_clock::time_point deadline_;
};

/// Bytes to and from the other side of a connected socket that does not block.
class Talk {
public:
    virtual ~Talk() = default;

    /// At most `size` bytes; 0: nothing yet. Throws NoAnswer if the other side has ended.
    virtual std::size_t read(char* into, std::size_t size) = 0;

    /// Few enough for the socket's buffer. Throws NoAnswer if they do not go.
    virtual void write(std::string_view bytes) = 0;
};

} // namespace fieldcast::listener
