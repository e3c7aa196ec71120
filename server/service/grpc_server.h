// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "server/access/access_watch.h"
#include "server/feed/feed.h"
#include "server/session/limits.h"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace fieldcast::service {

/// Port 0: any free one.
inline const HostPort kDefaultListen{.host = "127.0.0.1", .port = 50151};

/// The gRPC edge: Catalog, LightField, health and reflection. Health says SERVING from the constructor on, so make it
/// when every channel has rendered. Heartbeats and deadlines run on a thread of its own, another one follows changes of
/// tokens and certificates.
class GrpcServer {
public:
    /// Throws UserError if `address` has to be protected and is not, or a file of `security` is not usable, and
    /// std::runtime_error if the address cannot be listened on.
    GrpcServer(const HostPort& address, std::vector<std::shared_ptr<feed::Feed>> channels,
               const session::Limits& limits, const access::Security& security = {});
    /// Cuts what is still open.
    ~GrpcServer();

    int port() const; ///< the one listened on

    /// Health says NOT_SERVING, new sessions are refused, clients are told to go, spread over a second.
    void begin_drain(const std::string& reason);

    /// False: there are still sessions at `deadline`.
    bool wait_until_drained(std::chrono::steady_clock::time_point deadline);

    std::size_t session_count();

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::service
