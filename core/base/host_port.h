// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldcast {

/// An address such as "127.0.0.1:50151", "[::1]:0" or "localhost:80".
struct HostPort {
    std::string host; ///< IPv6 addresses in brackets
    int port = 0;     ///< 0 to 65535

    bool operator==(const HostPort&) const = default;
};

/// Parses HOST:PORT; empty if `text` has another form.
std::optional<HostPort> parse_host_port(std::string_view text);

std::string to_text(const HostPort& address);

/// Whether `host` is a loopback address: 127.0.0.0/8, [::1] or localhost. Queries no name service.
bool is_loopback(const std::string& host);

} // namespace fieldcast
