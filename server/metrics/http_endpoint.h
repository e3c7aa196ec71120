// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/access_watch.h"
#include "server/metrics/http_request.h"
#include "server/metrics/socket.h"

#include <functional>
#include <thread>

namespace fieldcast::metrics {

/// Serves one page at /metrics over HTTP/1.1: in plain text and to everybody on loopback, elsewhere over TLS to holders
/// of an admin token. One caller after the other, in a thread of its own; a slow one is cut after a few seconds.
class HttpEndpoint {
public:
    /// `gate` must outlive it. Throws UserError if `address` has to be protected and `security` does not do so, and
    /// std::runtime_error if it cannot be listened on.
    HttpEndpoint(const HostPort& address, const access::Security& security, const access::Gate& gate,
                 std::function<std::string()> page);

    int port() const { return port_of(listening_); } ///< the one listened on

private:
    void serve(const std::stop_token& stop);
    void answer(const Socket& caller);
    template <class Connection> void answer_on(Connection& connection);
    std::string answer_to(const HttpRequest& request);

    bool is_open_;                                         ///< no TLS, no token
    std::optional<access::CertificateFiles> certificates_; ///< unless open
    const access::Gate& gate_;
    std::function<std::string()> page_;
    Socket listening_;
    std::jthread thread_;
};

} // namespace fieldcast::metrics
