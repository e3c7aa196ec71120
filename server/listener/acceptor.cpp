// SPDX-License-Identifier: Apache-2.0
#include "server/listener/acceptor.h"

#include "core/base/log.h"
#include "core/base/rate_limit.h"
#include "server/listener/socket_address.h"

#include <cerrno>
#include <cstring>
#include <optional>

namespace fieldcast::listener {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kForEver{-1};
constexpr milliseconds kPauseAfterFailure{100};                             // until descriptors are closed
constexpr RateLimit::Rate kLogRate{.per_second = 1.0 / 60.0, .burst = 3.0}; // callers must not fill the disk

/// A name of the socket that is unique until the machine restarts; nothing if the descriptor is no longer a socket.
std::optional<std::uint64_t> cookie_of(int socket) {
    std::uint64_t cookie = 0;
    socklen_t size = sizeof cookie;
    return ::getsockopt(socket, SOL_SOCKET, SO_COOKIE, &cookie, &size) == 0 ? std::optional(cookie) : std::nullopt;
}

} // namespace

Acceptor::Acceptor(const ListeningSockets& sockets, std::size_t max_connections, Take take)
    : sockets_(sockets), max_connections_(max_connections), take_(std::move(take)),
      thread_([this](const std::stop_token& stop) { accept_until(stop); }) {}

Acceptor::Counts Acceptor::counts() const {
    auto state = state_.lock();
    std::erase_if(state->open, [](const Handed& one) { return cookie_of(one.number) != one.cookie; });
    state->counts.open = state->open.size();
    return state->counts;
}

void Acceptor::accept_until(const std::stop_token& stop) {
    const std::stop_callback on_stop(stop, [this] { wakeup_.stop(); });
    std::vector<pollfd> entries;
    for (const Descriptor& socket : sockets_.all()) {
        entries.push_back({.fd = socket.number(), .events = POLLIN, .revents = 0});
    }
    RateLimit log_rate(kLogRate);
    while (wakeup_.wait(entries, kForEver) != Wakeup::Outcome::kStopped) {
        for (const pollfd& entry : entries) {
            if (entry.revents == 0 || accept_one(entry.fd)) {
                continue;
            }
            if (log_rate.take(Clock::now())) {
                log::error("connection not accepted", {{"problem", std::strerror(errno)}});
            }
            wakeup_.wait({}, kPauseAfterFailure);
        }
    }
}

/// False: a connection is waiting, but accept() failed; see errno.
bool Acceptor::accept_one(int listening) {
    Descriptor connection(::accept4(listening, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (connection.is_open()) {
        if (is_admitted(connection.number())) {
            take_(listening, connection.release());
        }
        return true;
    }
    const bool is_ours = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
    state_.lock()->counts.failed += is_ours ? 1 : 0;
    return !is_ours; // otherwise the caller has already disconnected
}

bool Acceptor::is_admitted(int connection) {
    const auto cookie = cookie_of(connection);
    const SocketAddress caller = SocketAddress::far_end_of(connection);
    if (!cookie || caller.size == 0) {
        return false; // the caller has already disconnected
    }
    if (caller.port() == privileged_port_ && caller.has_host_of(SocketAddress::local_end_of(connection))) {
        return true; // only this process can use that port at the address that it listens on
    }
    const bool may_be_full = state_.lock()->open.size() >= max_connections_;
    const bool is_full = may_be_full && counts().open >= max_connections_;
    auto state = state_.lock();
    if (is_full) {
        ++state->counts.refused;
        return false;
    }
    ++state->counts.accepted;
    state->open.push_back({.number = connection, .cookie = *cookie});
    return true;
}

} // namespace fieldcast::listener
