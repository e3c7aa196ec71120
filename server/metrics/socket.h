// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"

#include <chrono>
#include <optional>
#include <utility>

namespace fieldcast::metrics {

/// A file descriptor of the kernel's, closed once.
class Socket {
public:
    explicit Socket(int descriptor = -1) : descriptor_(descriptor) {}
    Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    Socket& operator=(Socket&& other) noexcept;
    ~Socket() { close(); }

    int descriptor() const { return descriptor_; }

private:
    void close();
    int descriptor_;
};

/// Listens on `address`; port 0: any free one. Throws std::runtime_error.
Socket listen_on(const HostPort& address);

int port_of(const Socket& listening);

/// The next caller; nothing if none came within `timeout`. Its reads and writes give up after `patience`.
std::optional<Socket> accept(const Socket& listening, std::chrono::milliseconds timeout,
                             std::chrono::milliseconds patience);

} // namespace fieldcast::metrics
