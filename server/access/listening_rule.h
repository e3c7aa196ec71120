// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldcast::access {

/// What protects an address.
struct Protection {
    bool has_tls = false;
    bool has_tokens = false;
};

/// Why nobody may listen on `host`, or nothing: plain text stays on loopback, any other address needs both TLS and
/// tokens. (Tokens in plain text: on 127.0.0.1, [::1] and localhost, for which gRPC checks that callers are local.)
std::optional<std::string> listening_problem(const std::string& host, const Protection& protection);

/// Whether that version of gRPC ("1.51.1") is at least 1.57. Older ones let whoever reaches the port exhaust memory
/// (CVE-2023-33953, CVE-2023-44487) and descriptors (CVE-2023-4785) before any token is shown. What is no version
/// withstands nothing.
bool withstands_strangers(std::string_view grpc_version);

/// Why a server with that gRPC may not listen on `host`, or nothing: beyond loopback only one that withstands
/// strangers, unless the operator accepts those attacks.
std::optional<std::string> exposure_problem(const std::string& host, const std::string& grpc_version,
                                            bool accepts_known_attacks);

} // namespace fieldcast::access
