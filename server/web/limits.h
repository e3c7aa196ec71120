// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace fieldcast::web {

/// How many may be connected at the same time.
struct ConnectionLimits {
    std::size_t total = 32;
    std::size_t per_network = 8; ///< of one address; with IPv6 of one /64, since one caller has all addresses of that
};

/// What a caller may take of an endpoint. Callers who take longer are cut without an answer.
struct Limits {
    std::chrono::milliseconds exchange{10'000}; ///< all of it: from accepting to closing
    std::chrono::milliseconds handshake{3'000}; ///< of TLS
    std::chrono::milliseconds request{5'000};   ///< from the handshake to the request's last byte
    std::chrono::milliseconds parting{1'000};   ///< from the answer's last byte until the caller has closed, too

    std::size_t head_bytes = 8192; ///< of a request
    std::size_t body_bytes = 4096; ///< of a request

    ConnectionLimits connections{};
};

} // namespace fieldcast::web
