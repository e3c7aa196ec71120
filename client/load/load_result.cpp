// SPDX-License-Identifier: Apache-2.0
#include "client/load/load_result.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

namespace fieldcast::client::load {
namespace {

double milliseconds(std::int64_t us) {
    return static_cast<double>(us) * 1e-3;
}

template <class... Handlers> struct Overloaded : Handlers... { using Handlers::operator()...; };

double measured(Quantity quantity, const GroupResult& result) {
    const Tally& tally = result.tally;
    switch (quantity) {
    case Quantity::kLeastFps:
        return result.least_fps();
    case Quantity::kLeastFairness:
        return result.fairness;
    case Quantity::kMostFailed:
        return static_cast<double>(tally.failed);
    case Quantity::kMostAborted:
        return static_cast<double>(tally.aborted);
    case Quantity::kMostRefused:
        return static_cast<double>(tally.refused);
    case Quantity::kMostLost:
        return static_cast<double>(tally.lost);
    case Quantity::kMostWithout:
        return static_cast<double>(result.without_frames());
    }
    return 0.0;
}

/// A latency threshold without any values does not hold.
Check check(const Threshold& threshold, const GroupResult& result) {
    Check made{.group = result.group.name, .threshold = threshold};
    std::visit(Overloaded{[&](const LatencyLimit& limit) {
                              const LatencyHistogram& latencies = result.tally.of(limit.stage);
                              made.measured = milliseconds(latencies.percentile_us(limit.share));
                              made.holds = latencies.count() > 0 && made.measured <= threshold.limit;
                          },
                          [&](Quantity quantity) {
                              made.measured = measured(quantity, result);
                              const bool is_least =
                                  quantity == Quantity::kLeastFps || quantity == Quantity::kLeastFairness;
                              made.holds =
                                  is_least ? made.measured >= threshold.limit : made.measured <= threshold.limit;
                          }},
               threshold.of);
    return made;
}

template <class... Values> std::string line(const char* format, Values... values) {
    std::array<char, 512> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

std::string row(const LoadResult& result, const GroupResult& group) {
    const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    const Tally& tally = group.tally;
    const LatencyHistogram& due = tally.of(Stage::kDue);
    const double megabytes = static_cast<double>(tally.bytes) * 1e-6 / std::max(result.seconds, 1e-9);
    return line("%-18.18s %7u %9llu %8.2f %8.2f %6.3f %8.2f %9.1f %9.1f %9.1f %8llu %6llu %6llu\n",
                group.group.name.c_str(), group.group.count, number(tally.frames), group.mean_fps(), group.least_fps(),
                group.fairness, megabytes, milliseconds(due.percentile_us(0.5)), milliseconds(due.percentile_us(0.99)),
                milliseconds(due.largest_us()), number(tally.not_sent), number(tally.failed + tally.aborted),
                number(tally.lost + tally.refused));
}

} // namespace

double GroupResult::least_fps() const {
    return client_fps.empty() ? 0.0 : *std::ranges::min_element(client_fps);
}

double GroupResult::mean_fps() const {
    const double sum = std::accumulate(client_fps.begin(), client_fps.end(), 0.0);
    return client_fps.empty() ? 0.0 : sum / static_cast<double>(client_fps.size());
}

std::size_t GroupResult::without_frames() const {
    return static_cast<std::size_t>(std::ranges::count_if(client_fps, [](double fps) { return fps <= 0.0; }));
}

double LoadResult::cpu_percent_per_client() const {
    const std::uint32_t clients = client_count(scenario);
    return clients == 0 || seconds <= 0.0 ? 0.0 : 100.0 * cpu_seconds / seconds / clients;
}

bool LoadResult::has_frames() const {
    return std::ranges::any_of(groups, [](const GroupResult& group) { return group.tally.frames > 0; });
}

bool LoadResult::holds() const {
    return has_frames() && std::ranges::all_of(checks, &Check::holds);
}

std::vector<Check> checks_of(const Scenario& scenario, const std::vector<GroupResult>& groups) {
    std::vector<Check> checks;
    for (const GroupResult& result : groups) {
        for (const Threshold& own : result.group.thresholds) {
            checks.push_back(check(own, result));
        }
        for (const Threshold& common : scenario.thresholds) {
            const bool has_own = std::ranges::any_of(
                result.group.thresholds, [&](const Threshold& own) { return own.name == common.name; });
            if (!has_own) {
                checks.push_back(check(common, result));
            }
        }
    }
    return checks;
}

std::string to_table(const LoadResult& result) {
    std::string text = line("%-18s %7s %9s %8s %8s %6s %8s %9s %9s %9s %8s %6s %6s\n", "group", "clients", "frames",
                            "fps", "slowest", "Jain", "MB/s", "due p50", "due p99", "due max", "not sent", "failed",
                            "lost");
    for (const GroupResult& group : result.groups) {
        text += row(result, group);
    }
    text += line("%.1f s%s, %u clients, %.2f CPU seconds here (%.2f %% of a core per client). Times in ms.\n",
                 result.seconds, result.was_interrupted ? " (interrupted)" : "", client_count(result.scenario),
                 result.cpu_seconds, result.cpu_percent_per_client());
    for (const GroupResult& group : result.groups) {
        if (group.tally.cut_off > 0) {
            text += group.group.name + ": " + std::to_string(group.tally.cut_off) + " of " +
                    std::to_string(group.tally.of(Stage::kDue).count()) +
                    " due moments were still waiting when their client left; each counts with its wait so far\n";
        }
        for (const auto& [reason, count] : group.tally.reasons) {
            text += group.group.name + ": " + std::to_string(count) + " × " + reason + "\n";
        }
    }
    if (!result.metrics_problem.empty()) {
        text += "metrics: " + result.metrics_problem + "\n";
    }
    for (const Check& each : result.checks) {
        text += line("%s %s: %s %g, limit %g\n", each.holds ? "ok    " : "MISSED", each.group.c_str(),
                     each.threshold.name.c_str(), each.measured, each.threshold.limit);
    }
    return text;
}

} // namespace fieldcast::client::load
