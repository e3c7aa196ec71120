// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace fieldcast::client::net {

/// A call or a stream failed. Transient failures (no server, overload, a cut connection) are worth another attempt.
class NetError : public std::runtime_error {
public:
    NetError(const std::string& message, bool is_transient)
        : std::runtime_error(message), is_transient_(is_transient) {}
    bool is_transient() const { return is_transient_; }

private:
    bool is_transient_;
};

/// A plain-text HTTP/2 connection to one server, made by the first call. Thread-safe.
/// Each one dials anew: after a failure make another, at a pace given by `Backoff`.
class Connection {
public:
    /// `address` is "host:port" as gRPC understands it, "unix:/path" included.
    explicit Connection(const std::string& address);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    struct State; ///< for client/net only
    const State& state() const { return *state_; }

private:
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::client::net
