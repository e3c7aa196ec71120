// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/metrics_page.h"
#include "client/load/scenario.h"
#include "client/load/tally.h"

#include <string>
#include <vector>

namespace fieldcast::client::load {

/// A threshold and what became of it.
struct Check {
    std::string group;
    Threshold threshold;
    double measured = 0.0;
    bool holds = false;
};

struct GroupResult {
    Group group;
    Tally tally;
    std::vector<double> client_fps; ///< of each client, while it wanted frames
    double fairness = 1.0;          ///< Jain's index of `client_fps`

    double least_fps() const;              ///< of the slowest client
    double mean_fps() const;               ///< of all clients
    std::size_t without_frames() const;    ///< clients that got none
};

/// What a run has found out.
struct LoadResult {
    Scenario scenario;
    std::string began_at; ///< UTC, 2026-01-31T12:00:00Z
    double seconds = 0.0; ///< of the window
    bool was_interrupted = false;
    std::vector<GroupResult> groups;
    double cpu_seconds = 0.0; ///< of this process in the window, user and system
    Metrics metrics_before;   ///< of the server, at both ends of the window
    Metrics metrics_after;
    std::string metrics_problem; ///< empty: none
    std::vector<Check> checks;

    double cpu_percent_per_client() const; ///< of one core
    bool has_frames() const;
    bool holds() const; ///< every check does, and there were frames
};

/// The checks of all groups: their own thresholds and those of the scenario.
std::vector<Check> checks_of(const Scenario& scenario, const std::vector<GroupResult>& groups);

/// For people: a table with a line per group, then what did not hold.
std::string to_table(const LoadResult& result);

/// One object; keys carry their units. Everything that the table and the page say, and more.
std::string to_json(const LoadResult& result);

/// One self-contained HTML file.
std::string to_html(const LoadResult& result);

} // namespace fieldcast::client::load
