// SPDX-License-Identifier: Apache-2.0
#include "client/load/metrics_page.h"

#include "core/base/printable.h"

#include <algorithm>
#include <arpa/inet.h>
#include <charconv>
#include <cmath>
#include <cstring>
#include <netdb.h>
#include <optional>
#include <sstream>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace fieldcast::client::load {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxPageBytes = 4U << 20;
constexpr std::size_t kMaxMetrics = 10'000;

/// A connected socket, closed at the end.
class Socket {
public:
    explicit Socket(int descriptor) : descriptor_(descriptor) {}
    ~Socket() {
        if (descriptor_ >= 0) {
            ::close(descriptor_);
        }
    }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;

    bool is_open() const { return descriptor_ >= 0; }
    int descriptor() const { return descriptor_; }

private:
    int descriptor_;
};

/// A connected socket; −1 if the connection fails.
int connect_to(const HostPort& address, std::chrono::milliseconds patience) {
    std::string host = address.host;
    std::erase_if(host, [](char c) { return c == '[' || c == ']'; });
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(host.c_str(), std::to_string(address.port).c_str(), &hints, &found) != 0) {
        return -1;
    }
    const timeval limit{.tv_sec = patience.count() / 1000, .tv_usec = (patience.count() % 1000) * 1000};
    int connected = -1;
    for (const addrinfo* each = found; each != nullptr && connected < 0; each = each->ai_next) {
        const int descriptor = ::socket(each->ai_family, each->ai_socktype | SOCK_CLOEXEC, each->ai_protocol);
        if (descriptor < 0) {
            continue;
        }
        ::setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
        ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
        if (::connect(descriptor, each->ai_addr, each->ai_addrlen) == 0) {
            connected = descriptor;
        } else {
            ::close(descriptor);
        }
    }
    ::freeaddrinfo(found);
    return connected;
}

/// All bytes until the peer closes; nothing if it takes too long or sends too much.
std::optional<std::string> read_all(int descriptor, Clock::time_point deadline) {
    std::string text;
    char buffer[16384];
    while (Clock::now() < deadline) {
        const ssize_t count = ::recv(descriptor, buffer, sizeof buffer, 0);
        if (count == 0) {
            return text;
        }
        if (count < 0 || text.size() + static_cast<std::size_t>(count) > kMaxPageBytes) {
            return std::nullopt;
        }
        text.append(buffer, static_cast<std::size_t>(count));
    }
    return std::nullopt;
}

/// Where a sample's name with labels ends: at the first space outside of quotes.
std::size_t end_of_name(const std::string& line) {
    bool is_quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '\\' && is_quoted) {
            ++i;
        } else if (line[i] == '"') {
            is_quoted = !is_quoted;
        } else if (line[i] == ' ' && !is_quoted) {
            return i;
        }
    }
    return line.size();
}

} // namespace

tl::expected<MetricsUrl, std::string> parse_metrics_url(const std::string& url) {
    constexpr std::string_view kScheme = "http://";
    if (!url.starts_with(kScheme)) {
        return tl::unexpected(std::string("write http://127.0.0.1:PORT/metrics"));
    }
    const std::string rest = url.substr(kScheme.size());
    const std::size_t slash = rest.find('/');
    const auto address = parse_host_port(rest.substr(0, slash));
    const bool is_plain = std::ranges::all_of(url, [](unsigned char c) { return c > ' ' && c < 0x7F; });
    if (!address || address->port == 0 || !is_plain) {
        return tl::unexpected(std::string("write http://127.0.0.1:PORT/metrics"));
    }
    if (!is_loopback(address->host)) {
        return tl::unexpected("metrics are not encrypted, so the host must be this machine, not " + address->host);
    }
    return MetricsUrl{*address, slash == std::string::npos ? "/metrics" : rest.substr(slash)};
}

Metrics parse_metrics(const std::string& page) {
    Metrics metrics;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line) && metrics.size() < kMaxMetrics;) {
        const std::size_t cut = end_of_name(line);
        if (line.empty() || line[0] == '#' || cut == line.size()) {
            continue;
        }
        const char* const begin = line.data() + cut + 1;
        double value = 0.0;
        const auto parsed = std::from_chars(begin, line.data() + line.size(), value);
        if (parsed.ec == std::errc{} && std::isfinite(value)) {
            metrics[printable(line.substr(0, cut))] = value;
        }
    }
    return metrics;
}

tl::expected<Metrics, std::string> fetch_metrics(const MetricsUrl& url, std::chrono::milliseconds patience) {
    const auto deadline = Clock::now() + patience;
    const std::string name = "http://" + to_text(url.address) + url.path;
    const Socket socket(connect_to(url.address, patience));
    if (!socket.is_open()) {
        return tl::unexpected(name + ": the connection failed");
    }
    const std::string request =
        "GET " + url.path + " HTTP/1.0\r\nHost: " + to_text(url.address) + "\r\nConnection: close\r\n\r\n";
    if (::send(socket.descriptor(), request.data(), request.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(request.size())) {
        return tl::unexpected(name + ": the request cannot be sent");
    }
    const auto answer = read_all(socket.descriptor(), deadline);
    if (!answer) {
        return tl::unexpected(name + ": no complete answer of at most 4 MiB in time");
    }
    const std::size_t body = answer->find("\r\n\r\n");
    const std::string status = answer->substr(0, answer->find("\r\n"));
    if (body == std::string::npos || !status.starts_with("HTTP/1.") || status.find(" 200") == std::string::npos) {
        return tl::unexpected(name + ": answers '" + printable(status, 100) + "'");
    }
    return parse_metrics(answer->substr(body + 4));
}

} // namespace fieldcast::client::load
