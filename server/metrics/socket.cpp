// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/socket.h"

#include <memory>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace fieldcast::metrics {

namespace {

constexpr int kBacklog = 8;

/// "[::1]" -> "::1"
std::string without_brackets(const std::string& host) {
    return host.starts_with('[') && host.ends_with(']') ? host.substr(1, host.size() - 2) : host;
}

Socket try_to_listen(const addrinfo& address) {
    Socket socket(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const int yes = 1;
    setsockopt(socket.descriptor(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    const bool is_listening = socket.descriptor() >= 0 &&
                              bind(socket.descriptor(), address.ai_addr, address.ai_addrlen) == 0 &&
                              listen(socket.descriptor(), kBacklog) == 0;
    return is_listening ? std::move(socket) : Socket();
}

void set_patience(const Socket& socket, std::chrono::milliseconds patience) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(patience);
    const std::chrono::microseconds rest = patience - seconds;
    const timeval limit{.tv_sec = seconds.count(), .tv_usec = rest.count()};
    setsockopt(socket.descriptor(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    setsockopt(socket.descriptor(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
}

} // namespace

Socket& Socket::operator=(Socket&& other) noexcept {
    if (this != &other) {
        close();
        descriptor_ = std::exchange(other.descriptor_, -1);
    }
    return *this;
}

void Socket::close() {
    if (descriptor_ >= 0) {
        ::close(std::exchange(descriptor_, -1));
    }
}

Socket listen_on(const HostPort& address) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    addrinfo* found = nullptr;
    const std::string host = without_brackets(address.host);
    if (getaddrinfo(host.c_str(), std::to_string(address.port).c_str(), &hints, &found) != 0) {
        throw std::runtime_error("cannot listen on " + to_text(address) + ": there is no such host");
    }
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
    for (const addrinfo* candidate = found; candidate != nullptr; candidate = candidate->ai_next) {
        Socket socket = try_to_listen(*candidate);
        if (socket.descriptor() >= 0) {
            return socket;
        }
    }
    throw std::runtime_error("cannot listen on " + to_text(address) + "; is the port in use?");
}

int port_of(const Socket& listening) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getsockname(listening.descriptor(), reinterpret_cast<sockaddr*>(&address), &size) != 0) {
        return 0;
    }
    const in_port_t port = address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                                                         : reinterpret_cast<const sockaddr_in&>(address).sin_port;
    return ntohs(port);
}

std::optional<Socket> accept(const Socket& listening, std::chrono::milliseconds timeout,
                             std::chrono::milliseconds patience) {
    pollfd waiting{.fd = listening.descriptor(), .events = POLLIN, .revents = 0};
    if (poll(&waiting, 1, static_cast<int>(timeout.count())) != 1) {
        return std::nullopt;
    }
    Socket socket(accept4(listening.descriptor(), nullptr, nullptr, SOCK_CLOEXEC));
    if (socket.descriptor() < 0) {
        return std::nullopt;
    }
    set_patience(socket, patience);
    return socket;
}

} // namespace fieldcast::metrics
