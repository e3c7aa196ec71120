// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "server/access/access_watch.h"
#include "server/web/limits.h"
#include "server/web/route.h"

#include <memory>

namespace fieldcast::web {

/// Address of an endpoint and its protection.
struct Listening {
    HostPort address; ///< port 0: any free one
    std::string flag; ///< the flag of the address, for messages
    access::Security security;
};

/// Answers HTTP/1.1 at an address: one request per connection, many connections at once, in one thread of its own. On
/// loopback it uses plain text and admits all callers. Elsewhere it uses TLS and requires a token that the gate knows;
/// certificates are read again when they change. `limits` bound the time of every exchange; the destructor waits for
/// none.
class Endpoint {
public:
    /// `gate` must outlive it; handlers of routes run in its thread, one at a time. Throws UserError if the address
    /// needs protection that is missing or the certificate is not usable, and std::runtime_error if listening fails.
    Endpoint(const Listening& listening, const access::Gate& gate, std::vector<Route> routes,
             const Limits& limits = {});
    ~Endpoint();

    int port() const; ///< the listening port

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace fieldcast::web
