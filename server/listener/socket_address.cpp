// SPDX-License-Identifier: Apache-2.0
#include "server/listener/socket_address.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <netdb.h>
#include <netinet/in.h>

namespace fieldcast::listener {

namespace {

template <class Ask> SocketAddress asked(Ask ask, int socket) {
    SocketAddress address;
    address.size = sizeof address.bytes;
    if (ask(socket, reinterpret_cast<sockaddr*>(&address.bytes), &address.size) != 0) {
        address.size = 0;
    }
    return address;
}

/// The host without brackets: "[::1]" becomes "::1".
std::string without_brackets(const std::string& host) {
    return host.size() > 2 && host.front() == '[' && host.back() == ']' ? host.substr(1, host.size() - 2) : host;
}

} // namespace

int SocketAddress::port() const {
    return family() == AF_INET6 ? ntohs(reinterpret_cast<const sockaddr_in6*>(&bytes)->sin6_port)
                                : ntohs(reinterpret_cast<const sockaddr_in*>(&bytes)->sin_port);
}

void SocketAddress::set_port(int port) {
    const in_port_t value = htons(static_cast<in_port_t>(port));
    if (family() == AF_INET6) {
        reinterpret_cast<sockaddr_in6*>(&bytes)->sin6_port = value;
    } else {
        reinterpret_cast<sockaddr_in*>(&bytes)->sin_port = value;
    }
}

bool SocketAddress::has_host_of(const SocketAddress& other) const {
    SocketAddress same = other;
    same.set_port(port());
    return size == same.size && std::memcmp(&bytes, &same.bytes, size) == 0;
}

SocketAddress SocketAddress::local_end_of(int socket) {
    return asked(::getsockname, socket);
}

SocketAddress SocketAddress::far_end_of(int socket) {
    return asked(::getpeername, socket);
}

std::vector<SocketAddress> addresses_of(const HostPort& address) {
    addrinfo hints{};
    hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* first = nullptr;
    const std::string port = std::to_string(address.port);
    if (::getaddrinfo(without_brackets(address.host).c_str(), port.c_str(), &hints, &first) != 0) {
        return {};
    }
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> list(first, &::freeaddrinfo);
    std::vector<SocketAddress> found;
    for (const addrinfo* entry = first; entry != nullptr; entry = entry->ai_next) {
        SocketAddress one;
        one.size = std::min<socklen_t>(entry->ai_addrlen, sizeof one.bytes);
        std::memcpy(&one.bytes, entry->ai_addr, one.size);
        found.push_back(one);
    }
    return found;
}

} // namespace fieldcast::listener
