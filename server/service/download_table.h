// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/metrics/registry.h"
#include "server/service/catalog_call.h"
#include "server/session/limits.h"

#include <map>
#include <string>
#include <tl/expected.hpp>

namespace fieldcast::service {

/// All running scene downloads, the limits of their number, and counts of their results. Thread-safe.
class DownloadTable {
public:
    /// `registry` must outlive it.
    DownloadTable(const session::Limits& limits, metrics::Registry& registry);

    /// Admits a download by `peer`: returns its id, or a message that names the exceeded limit.
    tl::expected<std::uint64_t, std::string> admit(const std::string& peer);

    void remove(std::uint64_t id, CallEnd end, std::uint64_t bytes_sent);

private:
    struct State {
        std::map<std::uint64_t, std::string> places; ///< id and peer
        std::uint64_t next_id = 1;
    };

    const session::Limits limits_;
    metrics::Registry& registry_;
    metrics::Counter& bytes_;
    Guarded<State> state_;
    metrics::Collector collector_; ///< declared last, because it reads the places
};

} // namespace fieldcast::service
