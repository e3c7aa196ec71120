// SPDX-License-Identifier: Apache-2.0
#include "core/base/host_port.h"

#include <arpa/inet.h>
#include <charconv>

namespace fieldcast {

namespace {

constexpr int kMaxPort = 65535;
constexpr std::size_t kMaxHostBytes = 255; // RFC 1035, section 2.3.4

} // namespace

std::optional<HostPort> parse_host_port(std::string_view text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos || colon == 0 || colon > kMaxHostBytes) {
        return std::nullopt;
    }
    const std::string_view host = text.substr(0, colon);
    const bool has_brackets = host.front() == '[' && host.back() == ']';
    if (!has_brackets && host.find(':') != std::string_view::npos) {
        return std::nullopt; // ambiguous: an IPv6 address without brackets
    }
    int port = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, port);
    if (error != std::errc{} || rest != end || port < 0 || port > kMaxPort) {
        return std::nullopt;
    }
    return HostPort{.host = std::string(host), .port = port};
}

std::string to_text(const HostPort& address) {
    return address.host + ":" + std::to_string(address.port);
}

bool is_loopback(const std::string& host) {
    in_addr four{};
    if (inet_pton(AF_INET, host.c_str(), &four) == 1) {
        return (ntohl(four.s_addr) >> 24) == 127;
    }
    return host == "localhost" || host == "[::1]";
}

} // namespace fieldcast
