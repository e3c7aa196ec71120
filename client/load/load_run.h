// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/load_result.h"

#include <functional>
#include <stop_token>

namespace fieldcast::client::load {

/// Progress of a run, reported once a second.
struct LoadProgress {
    struct GroupLine {
        std::string name;
        std::uint32_t clients = 0;
        std::int64_t connected = 0;
        double fps = 0.0;                 ///< of all clients together, since the previous report
        double megabytes_per_second = 0.0; ///< since the previous report
        std::uint64_t frames = 0;
        double due_p50_ms = 0.0; ///< over the window so far
        double due_p99_ms = 0.0;
        std::uint64_t failed = 0; ///< failed or aborted frames
        std::uint64_t lost = 0;   ///< lost or refused streams
    };
    bool is_ramp = false;
    double seconds = 0.0; ///< since the ramp began, or since the window began
    double of_seconds = 0.0; ///< 0: until interrupted
    std::vector<GroupLine> groups;
};

/// Runs a scenario: ramp, window, then all clients leave. A stop request ends the window early. Throws UserError if the
/// address or a file of certificates or tokens is not usable.
LoadResult run_load(const Scenario& scenario, const std::function<void(const LoadProgress&)>& on_progress,
                    const std::stop_token& stop);

} // namespace fieldcast::client::load
