// SPDX-License-Identifier: Apache-2.0
#include "server/access/listening_rule.h"

#include "core/base/host_port.h"

#include <charconv>
#include <utility>

namespace fieldcast::access {

namespace {

constexpr std::pair kFirstThatWithstands{1, 57}; // major and minor

/// Major and minor number of "1.51.1"; nothing if the text does not begin with two numbers.
std::optional<std::pair<int, int>> major_and_minor(std::string_view version) {
    std::pair<int, int> numbers{};
    const char* const end = version.data() + version.size();
    const auto [dot, major_problem] = std::from_chars(version.data(), end, numbers.first);
    if (major_problem != std::errc() || dot == end || *dot != '.') {
        return std::nullopt;
    }
    const auto [rest, minor_problem] = std::from_chars(dot + 1, end, numbers.second);
    return minor_problem == std::errc() ? std::optional(numbers) : std::nullopt;
}

} // namespace

std::optional<std::string> listening_problem(const std::string& host, const Protection& protection) {
    const bool is_checked_loopback = host == "127.0.0.1" || host == "[::1]" || host == "localhost";
    if (is_loopback(host) && protection.has_tokens && !protection.has_tls && !is_checked_loopback) {
        return "must be 127.0.0.1, [::1] or localhost if there are tokens and no TLS";
    }
    if (is_loopback(host) || (protection.has_tls && protection.has_tokens)) {
        return std::nullopt;
    }
    const std::string lacks = protection.has_tls      ? "--tokens is missing"
                              : protection.has_tokens ? "--tls-cert and --tls-key are missing"
                                                      : "--tls-cert, --tls-key and --tokens are missing";
    return "is not a loopback address (127.0.0.1, [::1], localhost), so it needs TLS and tokens: " + lacks;
}

bool withstands_strangers(std::string_view grpc_version) {
    const auto numbers = major_and_minor(grpc_version);
    return numbers && *numbers >= kFirstThatWithstands;
}

std::optional<std::string> exposure_problem(const std::string& host, const std::string& grpc_version,
                                            bool accepts_known_attacks) {
    if (is_loopback(host) || accepts_known_attacks || withstands_strangers(grpc_version)) {
        return std::nullopt;
    }
    return "is not a loopback address, and this server is linked to gRPC " + grpc_version +
           ", which is older than 1.57: anyone who reaches the port can exhaust its memory and descriptors without a "
           "token. Listen on 127.0.0.1 with Envoy in front (deploy/envoy.yaml), or use --accept-known-grpc-attacks";
}

} // namespace fieldcast::access
