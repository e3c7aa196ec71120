// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace fieldcast::access {

/// What protects an address.
struct Protection {
    bool has_tls = false;
    bool has_tokens = false;
};

/// Why nobody may listen on `host`, or nothing: plain text stays on loopback, any other address needs both TLS and
/// tokens. (Tokens in plain text: on 127.0.0.1, [::1] and localhost, for which gRPC checks that callers are local.)
std::optional<std::string> listening_problem(const std::string& host, const Protection& protection);

} // namespace fieldcast::access
