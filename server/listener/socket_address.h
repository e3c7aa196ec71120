// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"

#include <sys/socket.h>
#include <vector>

namespace fieldcast::listener {

/// An address in the kernel's format.
struct SocketAddress {
    sockaddr_storage bytes{};
    socklen_t size = 0;

    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&bytes); }
    int family() const { return bytes.ss_family; }
    int port() const;
    void set_port(int port);
    bool has_host_of(const SocketAddress& other) const; ///< the ports may differ

    static SocketAddress local_end_of(int socket); ///< size 0: unknown
    static SocketAddress far_end_of(int socket);   ///< size 0: unknown
};

/// All addresses of a host name or numeric address, for listening; empty if there is none.
std::vector<SocketAddress> addresses_of(const HostPort& address);

} // namespace fieldcast::listener
