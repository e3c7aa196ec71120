// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/access/gate.h"
#include "server/metrics/registry.h"
#include "server/session/close_reason.h"
#include "server/session/session_counts.h"

#include <array>
#include <string>

namespace fieldcast::service {

/// Counters of the gRPC services. Thread-safe; `registry` must outlive it.
class ServiceMetrics {
public:
    explicit ServiceMetrics(metrics::Registry& registry);

    /// Creates the counters of `channel` with value 0, so that their first event is visible as a change.
    void prepare(const std::string& channel);

    void count_denied(access::Denial::Kind kind);
    void count_opened() { opened_.add(); }
    void count_refused(const std::string& reason); ///< "sessions", "draining", …
    void count_closed(session::CloseReason reason);

    /// Adds the events of a session of `channel` (empty: it has none yet) since the last call for it.
    void add(const std::string& channel, const session::SessionCounts& counts);

    metrics::Registry& registry() { return registry_; }

private:
    metrics::Registry& registry_;
    metrics::Counter& opened_;
};

} // namespace fieldcast::service
