// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/backoff.h"

#include <stdexcept>
#include <string>

namespace fieldcast::client::net {

/// A call or a stream failed. After transient failures (no server, overload, a broken connection) another attempt may
/// succeed.
class NetError : public std::runtime_error {
public:
    NetError(const std::string& message, bool is_transient, bool is_denied = false,
             Obstacle obstacle = Obstacle::kRefused)
        : std::runtime_error(message), is_transient_(is_transient), is_denied_(is_denied), obstacle_(obstacle) {}
    bool is_transient() const { return is_transient_; }

    /// The server requires a token, or another one.
    bool is_denied() const { return is_denied_; }

    /// For `Backoff`.
    Obstacle obstacle() const { return obstacle_; }

private:
    bool is_transient_;
    bool is_denied_;
    Obstacle obstacle_;
};

} // namespace fieldcast::client::net
