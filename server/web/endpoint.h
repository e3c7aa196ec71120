// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "server/access/access_watch.h"
#include "server/web/limits.h"
#include "server/web/route.h"

#include <memory>

namespace fieldcast::web {

/// Where an endpoint listens, and what protects it.
struct Listening {
    HostPort address; ///< port 0: any free one
    std::string flag; ///< that chose the address; for messages
    access::Security security;
};

/// Answers HTTP/1.1 at an address, one request per connection and many connections at once, in one thread of its own.
/// On loopback in plain text and to everybody; elsewhere over TLS, with certificates that are read again when they
/// change, to tokens that the gate knows. Nobody is waited for longer than `limits` say, and its end waits for nobody.
class Endpoint {
public:
    /// `gate` must outlive it; handlers of routes run in its thread, one at a time. Throws UserError if the address has
    /// to be protected and is not, or if the certificate is not usable, and std::runtime_error if it cannot be listened
    /// on.
    Endpoint(const Listening& listening, const access::Gate& gate, std::vector<Route> routes,
             const Limits& limits = {});
    ~Endpoint();

    int port() const; ///< the one listened on

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace fieldcast::web
