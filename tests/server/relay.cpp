// SPDX-License-Identifier: Apache-2.0
#include "tests/server/relay.h"

#include "tests/fixtures/http_client.h"

#include <array>
#include <netinet/in.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace fieldcast::test {

namespace {

constexpr int kLookAtStop_ms = 20;

bool wait_for_input(int descriptor) {
    pollfd wanted{.fd = descriptor, .events = POLLIN, .revents = 0};
    return poll(&wanted, 1, kLookAtStop_ms) == 1;
}

/// Moves what has arrived. False: that end has closed.
bool move_bytes(int from, int to) {
    std::array<char, 65536> buffer{};
    const ssize_t count = recv(from, buffer.data(), buffer.size(), MSG_DONTWAIT);
    for (ssize_t sent = 0; sent < count;) {
        const auto left = static_cast<std::size_t>(count - sent);
        const ssize_t step = send(to, buffer.data() + sent, left, MSG_NOSIGNAL);
        if (step <= 0) {
            return false;
        }
        sent += step;
    }
    return count != 0;
}

} // namespace

Relay::Relay(int target_port) : target_port_(target_port), listening_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (bind(listening_, any, size) != 0 || listen(listening_, 1) != 0 || getsockname(listening_, any, &size) != 0) {
        throw std::runtime_error("cannot listen");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { pass_on(stop); });
}

Relay::~Relay() {
    thread_ = {}; // stops and joins
    close(listening_);
}

void Relay::pass_on(const std::stop_token& stop) {
    while (!stop.stop_requested() && !wait_for_input(listening_)) {
    }
    const int caller = stop.stop_requested() ? -1 : accept(listening_, nullptr, nullptr);
    if (caller < 0) {
        return;
    }
    const HttpCaller target("127.0.0.1", target_port_);
    for (bool is_open = true; is_open && !stop.stop_requested();) {
        std::array<pollfd, 2> ends{pollfd{.fd = caller, .events = POLLIN, .revents = 0},
                                   pollfd{.fd = target.descriptor(), .events = POLLIN, .revents = 0}};
        poll(is_silent_ ? nullptr : ends.data(), is_silent_ ? 0 : ends.size(), kLookAtStop_ms);
        is_open = is_silent_ || ((ends[0].revents == 0 || move_bytes(caller, target.descriptor())) &&
                                 (ends[1].revents == 0 || move_bytes(target.descriptor(), caller)));
    }
    close(caller);
}

} // namespace fieldcast::test
