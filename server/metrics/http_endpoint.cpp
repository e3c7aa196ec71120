// SPDX-License-Identifier: Apache-2.0
#include "server/metrics/http_endpoint.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "server/access/listening_rule.h"
#include "server/access/tls_connection.h"

#include <array>
#include <csignal>
#include <sys/socket.h>

namespace fieldcast::metrics {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLookAtStop{100};
constexpr std::chrono::milliseconds kReadPatience{2000};
constexpr std::chrono::seconds kLongestRequest{5};
constexpr std::string_view kMetricsType = "text/plain; version=0.0.4; charset=utf-8";
constexpr std::string_view kTextType = "text/plain; charset=utf-8";

/// A socket without TLS, with the same two functions as one with it.
class PlainConnection {
public:
    explicit PlainConnection(int socket) : socket_(socket) {}

    std::size_t read(std::span<char> buffer) {
        const ssize_t count = recv(socket_, buffer.data(), buffer.size(), 0);
        return count > 0 ? static_cast<std::size_t>(count) : 0;
    }

    bool write(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t count = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (count <= 0) {
                return false;
            }
            bytes.remove_prefix(static_cast<std::size_t>(count));
        }
        return true;
    }

private:
    int socket_;
};

/// Reads until the empty line; nothing if it does not come, or not soon enough.
template <class Connection> std::optional<std::string> read_head(Connection& connection) {
    const auto deadline = Clock::now() + kLongestRequest;
    std::string head;
    std::array<char, 1024> buffer{};
    while (head.size() < kMaxHeadBytes && Clock::now() < deadline) {
        const std::size_t count = connection.read(buffer);
        if (count == 0) {
            return std::nullopt;
        }
        head.append(buffer.data(), count);
        const std::size_t end = head.find("\r\n\r\n");
        if (end != std::string::npos) {
            head.resize(end + 4);
            return head;
        }
    }
    return std::nullopt;
}

/// So that a caller who goes away does not end the process.
void block_broken_pipe() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

} // namespace

HttpEndpoint::HttpEndpoint(const HostPort& address, const access::Security& security, const access::Gate& gate,
                           std::function<std::string()> page)
    : is_open_(is_loopback(address.host)), certificates_(security.certificates), gate_(gate), page_(std::move(page)) {
    const access::Protection protection{.has_tls = security.certificates.has_value(),
                                        .has_tokens = security.tokens.has_value()};
    const auto problem = is_open_ ? std::nullopt : access::listening_problem(address.host, protection);
    if (problem) {
        throw UserError("--metrics-listen " + to_text(address) + " " + *problem);
    }
    listening_ = listen_on(address);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

void HttpEndpoint::serve(const std::stop_token& stop) {
    block_broken_pipe();
    while (!stop.stop_requested()) {
        const auto caller = accept(listening_, kLookAtStop, kReadPatience);
        if (!caller) {
            continue;
        }
        try {
            answer(*caller);
        } catch (const std::exception& problem) {
            log::debug("scrape failed", {{"problem", problem.what()}});
        }
    }
}

void HttpEndpoint::answer(const Socket& caller) {
    if (is_open_) {
        PlainConnection connection(caller.descriptor());
        answer_on(connection);
        shutdown(caller.descriptor(), SHUT_WR);
    } else {
        access::TlsConnection connection(caller.descriptor(), *certificates_);
        answer_on(connection);
    }
}

template <class Connection> void HttpEndpoint::answer_on(Connection& connection) {
    const auto head = read_head(connection);
    const auto request = head ? parse_http_request(*head) : std::nullopt;
    connection.write(request ? answer_to(*request) : http_answer(400, kTextType, "this is no request\n", true));
}

std::string HttpEndpoint::answer_to(const HttpRequest& request) {
    const bool has_body = request.method != "HEAD";
    const auto answer = [&](int status, const std::string& text) {
        return http_answer(status, status == 200 ? kMetricsType : kTextType, text, has_body);
    };
    if (!is_open_) {
        const auto identity = gate_.admit(request.authorization, request.path, access::Role::kAdmin);
        if (!identity) {
            const bool is_known = identity.error().kind == access::Denial::Kind::kRoleTooLow;
            return answer(is_known ? 403 : 401, identity.error().message + "\n");
        }
    }
    if (request.method != "GET" && request.method != "HEAD") {
        return answer(405, "GET it\n");
    }
    return request.path == "/metrics" ? answer(200, page_()) : answer(404, "there is only /metrics\n");
}

} // namespace fieldcast::metrics
