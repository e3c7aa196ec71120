// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/host_port.h"
#include "core/timing/timing_recorder.h"
#include "server/access/access_watch.h"
#include "server/feed/feed.h"
#include "server/metrics/registry.h"
#include "server/session/limits.h"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace fieldcast::service {

/// Receivers of the server's metrics and frame timings.
struct Observation {
    std::shared_ptr<metrics::Registry> registry = std::make_shared<metrics::Registry>();
    timing::TimingRecorder* recorder = nullptr; ///< of frame timings; null: none; must outlive the server
};

/// The gRPC services: Catalog, LightField, health and reflection. Health is SERVING from the constructor on, so
/// construct it after every channel has rendered a frame. Health is NOT_SERVING while the server drains, while clients
/// wait for frames of a channel beyond the deadline, and while the server's own port does not answer. One thread
/// handles heartbeats and deadlines; others accept connections, probe the port, and watch tokens and certificates.
class GrpcServer {
public:
    /// Throws UserError if `address` needs protection that `security` lacks or a file of `security` is not usable, and
    /// std::runtime_error if listening on the address fails.
    GrpcServer(const HostPort& address, const std::vector<std::shared_ptr<feed::Feed>>& channels,
               const session::Limits& limits, const access::Security& security = {},
               const Observation& observation = {});
    /// Cancels all open calls.
    ~GrpcServer();

    int port() const; ///< the listening port

    /// Begins to drain: health is NOT_SERVING, new sessions are refused, clients get GoingAway spread over 1 s.
    void begin_drain(const std::string& reason);

    /// Waits until there are no sessions. False: there are still some at `deadline`.
    bool wait_until_drained(std::chrono::steady_clock::time_point deadline);

    /// Several probes of the port in a row had no answer: new clients cannot connect.
    bool is_deaf() const;

    std::size_t session_count();
    const access::Gate& gate() const; ///< for other endpoints; valid as long as this object

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fieldcast::service
