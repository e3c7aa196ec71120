// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace fieldcast::web {

/// Largest numbers of connections at the same time.
struct ConnectionLimits {
    std::size_t total = 32;
    std::size_t per_network = 8; ///< per IPv4 address or IPv6 /64, because one caller has a whole /64
};

/// Limits of time and size per caller. Callers that exceed a time are disconnected without an answer.
struct Limits {
    std::chrono::milliseconds exchange{10'000}; ///< the whole exchange, from accepting to closing
    std::chrono::milliseconds handshake{3'000}; ///< TLS handshake
    std::chrono::milliseconds request{5'000};   ///< from the handshake to the request's last byte
    std::chrono::milliseconds parting{1'000};   ///< from the answer's last byte until the caller closes

    std::size_t head_bytes = 8192; ///< of a request
    std::size_t body_bytes = 4096; ///< of a request

    ConnectionLimits connections{};
};

} // namespace fieldcast::web
