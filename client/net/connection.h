// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/access.h"
#include "client/net/backoff.h"

#include <memory>
#include <stdexcept>
#include <string>

namespace fieldcast::client::net {

/// A call or a stream failed. Transient failures (no server, overload, a cut connection) are worth another attempt.
class NetError : public std::runtime_error {
public:
    NetError(const std::string& message, bool is_transient, bool is_denied = false,
             Obstacle obstacle = Obstacle::kRefused)
        : std::runtime_error(message), is_transient_(is_transient), is_denied_(is_denied), obstacle_(obstacle) {}
    bool is_transient() const { return is_transient_; }

    /// The server asks for a token, or for another one.
    bool is_denied() const { return is_denied_; }

    /// For `Backoff`.
    Obstacle obstacle() const { return obstacle_; }

private:
    bool is_transient_;
    bool is_denied_;
    Obstacle obstacle_;
};

/// An HTTP/2 connection to one server, made by the first call. Thread-safe.
/// Each one dials anew: after a failure make another, at a pace given by `Backoff`.
class Connection {
public:
    /// `address` is "host:port" as gRPC understands it, "unix:/path" included. Throws UserError if a file of `access`
    /// cannot be used, or if its token would leave this machine unencrypted.
    explicit Connection(const std::string& address, const Access& access = {});
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    struct State; ///< for client/net only
    const State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::client::net
