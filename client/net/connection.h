// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/net/access.h"
#include "client/net/net_error.h"

#include <memory>
#include <string>

namespace fieldcast::client::net {

struct ConnectionState;

/// An HTTP/2 connection to one server, opened by the first call. Thread-safe.
/// It does not recover from a failure: make another one, at the pace that `Backoff` gives.
class Connection {
public:
    /// `address` is "host:port" as gRPC understands it, "unix:/path" included. Throws UserError if a file of `access`
    /// cannot be used, or if its token would leave this machine unencrypted.
    explicit Connection(const std::string& address, const Access& access = {});
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    const ConnectionState& state() const { return *state_; } ///< for client/net only

private:
    std::unique_ptr<ConnectionState> state_;
};

} // namespace fieldcast::client::net
