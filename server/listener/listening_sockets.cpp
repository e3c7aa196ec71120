// SPDX-License-Identifier: Apache-2.0
#include "server/listener/listening_sockets.h"

#include "server/listener/socket_address.h"

#include <cerrno>
#include <cstring>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdexcept>

namespace fieldcast::listener {

namespace {

/// Sets an option, which accepted connections inherit from the listening socket.
void set(int socket, int level, int option, int value) {
    ::setsockopt(socket, level, option, &value, sizeof value); // errors are ignored: every option is optional
}

/// A socket that listens at this address; on failure none, and errno is set.
Descriptor listen_on(const SocketAddress& address, std::chrono::milliseconds silence) {
    Descriptor socket(::socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!socket.is_open()) {
        return socket;
    }
    set(socket.number(), SOL_SOCKET, SO_REUSEADDR, 1); // for a quick restart; a second server at the port still fails
    set(socket.number(), IPPROTO_TCP, TCP_NODELAY, 1);
    set(socket.number(), IPPROTO_TCP, TCP_USER_TIMEOUT, static_cast<int>(silence.count()));
    const bool listens =
        ::bind(socket.number(), address.get(), address.size) == 0 && ::listen(socket.number(), SOMAXCONN) == 0;
    return listens ? std::move(socket) : Descriptor();
}

} // namespace

ListeningSockets::ListeningSockets(const HostPort& address, std::chrono::milliseconds silence) : port_(address.port) {
    int problem = EADDRNOTAVAIL;
    for (SocketAddress one : addresses_of(address)) {
        one.set_port(port_); // all use the port of the first one
        Descriptor socket = listen_on(one, silence);
        if (socket.is_open()) {
            port_ = SocketAddress::local_end_of(socket.number()).port();
            all_.push_back(std::move(socket));
        } else {
            problem = errno;
        }
        if (problem == EADDRINUSE) {
            break;
        }
    }
    if (all_.empty() || problem == EADDRINUSE) {
        throw std::runtime_error("cannot listen on " + to_text(address) + ": " + std::strerror(problem) +
                                 "; is the port in use?");
    }
}

} // namespace fieldcast::listener
