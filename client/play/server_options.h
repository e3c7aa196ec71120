// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/access.h"

#include <chrono>
#include <string>

namespace fieldcast::client::play {

/// How to reach a server, and how long to try.
struct ServerOptions {
    std::string address = "127.0.0.1:50151"; ///< "host:port"
    net::Access access{};
    bool reconnects = true;
    std::chrono::milliseconds patience{30'000}; ///< time without a success after which to give up
};

} // namespace fieldcast::client::play
