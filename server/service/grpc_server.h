// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "core/timing/recorder.h"
#include "server/access/access_watch.h"
#include "server/feed/feed.h"
#include "server/metrics/registry.h"
#include "server/session/limits.h"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace fieldcast::service {

/// Port 0: any free one.
inline const HostPort kDefaultListen{.host = "127.0.0.1", .port = 50151};

/// Of the gRPC that this program is linked to at run time, as in "1.51.1".
std::string grpc_version();

/// Where the server tells what it does.
struct Observation {
    std::shared_ptr<metrics::Registry> registry = std::make_shared<metrics::Registry>();
    timing::Recorder* recorder = nullptr; ///< of frames and clients; null: none; must outlive the server
};

/// The gRPC edge: Catalog, LightField, health and reflection. Health says SERVING from the constructor on, so make it
/// when every channel has rendered; it says NOT_SERVING while the server drains, while somebody waits in vain for frames
/// of a channel, and while its own port does not answer it. Heartbeats and deadlines run on a thread of its own, others
/// accept connections, ask the own port, and follow changes of tokens and certificates.
class GrpcServer {
public:
    /// Throws UserError if `address` has to be protected and is not, or a file of `security` is not usable, and
    /// std::runtime_error if the address cannot be listened on.
    GrpcServer(const HostPort& address, const std::vector<std::shared_ptr<feed::Feed>>& channels,
               const session::Limits& limits, const access::Security& security = {},
               const Observation& observation = {});
    /// Cuts what is still open.
    ~GrpcServer();

    int port() const; ///< the one listened on

    /// Health says NOT_SERVING, new sessions are refused, clients are told to go, spread over a second.
    void begin_drain(const std::string& reason);

    /// False: there are still sessions at `deadline`.
    bool wait_until_drained(std::chrono::steady_clock::time_point deadline);

    /// The port has not answered the server itself several times in a row: nobody new gets in.
    bool is_deaf() const;

    std::size_t session_count();
    const access::Gate& gate() const; ///< for other ways in, as long as this lives

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::service
