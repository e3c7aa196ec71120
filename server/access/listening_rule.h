// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fieldcast::access {

/// Protection of a listening address.
struct Protection {
    bool has_tls = false;
    bool has_tokens = false;
};

/// Why a server with this protection must not listen on `host`, or nothing. Plain text is allowed on loopback only; any
/// other address needs TLS and tokens. Tokens without TLS are allowed on 127.0.0.1, [::1] and localhost, for which gRPC
/// checks that callers are local.
std::optional<std::string> listening_problem(const std::string& host, const Protection& protection);

/// Whether `grpc_version` ("1.51.1") is at least 1.57. In older versions, anyone who reaches the port can exhaust
/// memory (CVE-2023-33953, CVE-2023-44487) and descriptors (CVE-2023-4785) without a token. False if it is not a
/// version.
bool withstands_strangers(std::string_view grpc_version);

/// Why a server with this version of gRPC must not listen on `host`, or nothing. Beyond loopback, it must be at least
/// 1.57, unless the operator accepts these attacks.
std::optional<std::string> exposure_problem(const std::string& host, const std::string& grpc_version,
                                            bool accepts_known_attacks);

} // namespace fieldcast::access
