// SPDX-License-Identifier: Apache-2.0
#include "server/access/listening_rule.h"

#include "core/base/host_port.h"

namespace fieldcast::access {

std::optional<std::string> listening_problem(const std::string& host, const Protection& protection) {
    const bool is_checked_loopback = host == "127.0.0.1" || host == "[::1]" || host == "localhost";
    if (is_loopback(host) && protection.has_tokens && !protection.has_tls && !is_checked_loopback) {
        return "with tokens and without TLS has to be 127.0.0.1, [::1] or localhost";
    }
    if (is_loopback(host) || (protection.has_tls && protection.has_tokens)) {
        return std::nullopt;
    }
    const std::string lacks = protection.has_tls      ? "--tokens is missing"
                              : protection.has_tokens ? "--tls-cert and --tls-key are missing"
                                                      : "--tls-cert, --tls-key and --tokens are missing";
    return "is not a loopback address (127.0.0.1, [::1], localhost), so it needs TLS and tokens: " + lacks;
}

} // namespace fieldcast::access
