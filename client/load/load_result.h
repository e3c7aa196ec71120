// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/metrics_page.h"
#include "client/load/scenario.h"
#include "client/load/tally.h"

#include <string>
#include <vector>

namespace fieldcast::client::load {

/// A threshold and the value measured for it.
struct Check {
    std::string group;
    Threshold threshold;
    double measured = 0.0;
    bool holds = false;
};

struct GroupResult {
    Group group;
    Tally tally;
    std::vector<double> client_fps; ///< frame rate of each client while it wanted frames
    double fairness = 1.0;          ///< Jain's index of `client_fps`

    double least_fps() const;              ///< frame rate of the slowest client
    double mean_fps() const;               ///< mean frame rate of the clients
    std::size_t without_frames() const;    ///< number of clients that received none
};

/// The result of a run.
struct LoadResult {
    Scenario scenario;
    std::string began_at; ///< UTC, 2026-01-31T12:00:00Z
    double seconds = 0.0; ///< length of the window
    bool was_interrupted = false;
    std::vector<GroupResult> groups;
    double cpu_seconds = 0.0; ///< of this process in the window, user and system
    Metrics metrics_before;   ///< of the server at the begin of the window; `metrics_after`: at its end
    Metrics metrics_after;
    std::string metrics_problem; ///< why metrics are missing; empty: they are not
    std::vector<Check> checks;

    double cpu_percent_per_client() const; ///< percent of one core
    bool has_frames() const;
    bool holds() const; ///< every check holds, and there were frames
};

/// Checks all groups against their own thresholds and those of the scenario.
std::vector<Check> checks_of(const Scenario& scenario, const std::vector<GroupResult>& groups);

/// A table for the terminal: a line per group, then problems and checks.
std::string to_table(const LoadResult& result);

/// One JSON object whose keys name their units. Contains more than the table and the HTML page.
std::string to_json(const LoadResult& result);

/// The report as one self-contained HTML file.
std::string to_html(const LoadResult& result);

} // namespace fieldcast::client::load
