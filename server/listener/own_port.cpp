// SPDX-License-Identifier: Apache-2.0
// HTTP/2 as far as a PING needs it: RFC 9113, sections 3.4 (preface), 4.1 (frames), 6.7 (PING).
#include "server/listener/own_port.h"

#include "server/listener/tls_talk.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <netinet/in.h>
#include <system_error>

namespace fieldcast::listener {

namespace {

using namespace std::string_view_literals;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kPreface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"sv;
constexpr std::string_view kEmptySettings = "\0\0\0\x04\0\0\0\0\0"sv;
constexpr std::string_view kPing = "\0\0\x08\x06\0\0\0\0\0fc-alive"sv;
constexpr std::string_view kPong = "\0\0\x08\x06\x01\0\0\0\0fc-alive"sv;
constexpr std::size_t kMaxAnswerBytes = 16 << 10; // settings and window updates precede the PING's answer

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

[[noreturn]] void give_up(const std::string& what) {
    throw NoAnswer(what + ": " + std::strerror(errno));
}

class PlainTalk final : public Talk {
public:
    explicit PlainTalk(int socket) : socket_(socket) {}

    std::size_t read(char* into, std::size_t size) override {
        const ssize_t count = ::recv(socket_, into, size, 0);
        if (count == 0) {
            throw NoAnswer("the connection ended before an answer");
        }
        if (count < 0 && errno != EAGAIN) {
            give_up("the connection ended");
        }
        return count > 0 ? static_cast<std::size_t>(count) : 0;
    }

    void write(std::string_view bytes) override {
        if (::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(bytes.size())) {
            give_up("the connection accepts no data");
        }
    }

private:
    int socket_;
};

/// Loopback address of a socket that listens on all addresses.
SocketAddress reachable(SocketAddress address) {
    auto* const four = reinterpret_cast<sockaddr_in*>(&address.bytes);
    auto* const six = reinterpret_cast<sockaddr_in6*>(&address.bytes);
    if (address.family() == AF_INET && four->sin_addr.s_addr == htonl(INADDR_ANY)) {
        four->sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    } else if (address.family() == AF_INET6 && IN6_IS_ADDR_UNSPECIFIED(&six->sin6_addr)) {
        six->sin6_addr = in6addr_loopback;
    }
    return address;
}

/// False: the thread must stop.
bool connect_to(const SocketAddress& target, int socket, const Patience& patience) {
    if (::connect(socket, target.get(), target.size) == 0) {
        return true;
    }
    if (errno != EINPROGRESS) {
        give_up("no connection");
    }
    if (!patience.wait(POLLOUT)) {
        return false;
    }
    int problem = 0;
    socklen_t size = sizeof problem;
    ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &problem, &size);
    if (problem != 0) {
        errno = problem;
        give_up("no connection");
    }
    return true;
}

void exchange_ping(Talk& talk, const Patience& patience) {
    std::string request(kPreface);
    request.append(kEmptySettings).append(kPing);
    talk.write(request);
    std::string answer;
    std::array<char, 1024> piece{};
    while (answer.find(kPong) == std::string::npos) {
        if (answer.size() > kMaxAnswerBytes) {
            throw NoAnswer("the answer is not a PING acknowledgement");
        }
        const std::size_t count = talk.read(piece.data(), piece.size());
        answer.append(piece.data(), count);
        if (count == 0 && !patience.wait(POLLIN)) {
            return;
        }
    }
}

void ask(Speech speech, int socket, const Patience& patience) {
    if (speech == Speech::kPlain) {
        PlainTalk talk(socket);
        return exchange_ping(talk, patience);
    }
    TlsTalk talk(socket);
    try {
        if (talk.shake_hands(patience) && speech == Speech::kTls) {
            exchange_ping(talk, patience);
        }
    } catch (const NoAnswer&) {
        if (speech != Speech::kTlsForKnownClients || !talk.has_heard()) {
            throw;
        }
    }
}

/// Ends the connection and keeps the socket and its port: connect(2), "dissolve the association".
void disconnect(int socket) {
    sockaddr nobody{};
    nobody.sa_family = AF_UNSPEC;
    ::connect(socket, &nobody, sizeof nobody);
}

} // namespace

bool Patience::wait(short events) const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now());
    std::array entries{pollfd{.fd = socket_, .events = events, .revents = 0}};
    switch (left.count() > 0 ? wakeup_.wait(entries, left) : Wakeup::Outcome::kLate) {
    case Wakeup::Outcome::kReady:
        return true;
    case Wakeup::Outcome::kLate:
        throw NoAnswer("no answer in time");
    case Wakeup::Outcome::kStopped:
        break;
    }
    return false;
}

OwnPort::OwnPort(int listening, Speech speech)
    : target_(reachable(SocketAddress::local_end_of(listening))), speech_(speech),
      socket_(::socket(target_.family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    SocketAddress any = target_;
    any.set_port(0);
    if (!socket_.is_open() || ::bind(socket_.number(), any.get(), any.size) != 0) {
        fail("creating the socket of the self-probe");
    }
    local_port_ = SocketAddress::local_end_of(socket_.number()).port();
}

std::optional<std::string> OwnPort::problem(const Wakeup& wakeup, std::chrono::milliseconds patience) {
    const Patience until(wakeup, socket_.number(), patience);
    std::optional<std::string> problem;
    try {
        if (connect_to(target_, socket_.number(), until)) {
            ask(speech_, socket_.number(), until);
        }
    } catch (const NoAnswer& none) {
        problem = none.what();
    }
    disconnect(socket_.number());
    return problem;
}

} // namespace fieldcast::listener
