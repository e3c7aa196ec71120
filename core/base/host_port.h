// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldcast {

/// "127.0.0.1:50151", "[::1]:0", "localhost:80".
struct HostPort {
    std::string host; ///< IPv6 addresses in brackets
    int port = 0;     ///< 0 to 65535

    bool operator==(const HostPort&) const = default;
};

/// Nothing unless `text` is HOST:PORT.
std::optional<HostPort> parse_host_port(std::string_view text);

std::string to_text(const HostPort& address);

/// Whether what is sent to `host` stays on this machine: 127.0.0.0/8, [::1] and localhost. Asks no name service.
bool is_loopback(const std::string& host);

} // namespace fieldcast
