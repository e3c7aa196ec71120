// SPDX-License-Identifier: Apache-2.0
#include "client/load/load_result.h"
#include "report/chart.h"
#include "report/curve_chart.h"
#include "report/page.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::client::load {
namespace {

using report::fixed;
using report::Markup;

constexpr std::size_t kSeries = 8;      // colours of the style sheet
constexpr std::size_t kMostPoints = 300; // most points of a curve over time
constexpr double kMostNines = 4.0;       // percentile curves end at 99.99 %

double milliseconds(std::int64_t us) {
    return static_cast<double>(us) * 1e-3;
}

std::string in_ms(const LatencyHistogram& latencies, double share) {
    return latencies.count() == 0 ? "–" : fixed(milliseconds(latencies.percentile_us(share)), 1);
}

std::string lead(const LoadResult& result) {
    std::uint64_t frames = 0;
    for (const GroupResult& group : result.groups) {
        frames += group.tally.frames;
    }
    const auto missed = std::ranges::count_if(result.checks, [](const Check& check) { return !check.holds; });
    std::string text = report::joined({std::to_string(client_count(result.scenario)), " clients received ",
                                       std::to_string(frames), " frames in ", fixed(result.seconds, 1), " seconds",
                                       result.was_interrupted ? " (interrupted)." : "."});
    if (result.checks.empty()) {
        return text;
    }
    return text + (missed == 0 ? std::string(" Every threshold holds.")
                               : report::joined({" ", std::to_string(missed), " of ",
                                                 std::to_string(result.checks.size()), " thresholds were missed."}));
}

Markup group_table(const LoadResult& result) {
    report::Table table{.titles = {"group", "clients", "mode", "grid", "frames", "fps", "slowest fps", "Jain", "MB/s",
                                   "not sent", "aborted", "failed", "refused", "lost"},
                        .rows = {}};
    for (const GroupResult& group : result.groups) {
        const Tally& tally = group.tally;
        const double megabytes = static_cast<double>(tally.bytes) * 1e-6 / std::max(result.seconds, 1e-9);
        table.rows.push_back({group.group.name, std::to_string(group.group.count),
                              std::string(word_of(group.group.request.mode)),
                              std::to_string(group.group.request.rows) + "×" + std::to_string(group.group.request.cols),
                              std::to_string(tally.frames), fixed(group.mean_fps(), 2), fixed(group.least_fps(), 2),
                              fixed(group.fairness, 3), fixed(megabytes, 2), std::to_string(tally.not_sent),
                              std::to_string(tally.aborted), std::to_string(tally.failed),
                              std::to_string(tally.refused), std::to_string(tally.lost)});
    }
    return report::table(table);
}

Markup check_table(const LoadResult& result) {
    report::Table table{.titles = {"group", "threshold", "measured", "limit", ""}, .rows = {}};
    for (const Check& check : result.checks) {
        table.rows.push_back({check.group, check.threshold.name, fixed(check.measured, 2),
                              fixed(check.threshold.limit, 2), check.holds ? "holds" : "MISSED"});
    }
    return report::table(table);
}

/// Reduces one value per second to at most `kMostPoints`: means or maxima of neighbouring seconds.
enum class Join : std::uint8_t { kMean, kPeak };
template <class Value>
report::Curve over_time(const LoadResult& result, std::size_t index, Join join, Value value) {
    const GroupResult& group = result.groups[index];
    report::Curve curve{.label = group.group.name, .points = {}, .series = index % kSeries};
    const std::vector<Second>& seconds = group.tally.seconds;
    const auto length = static_cast<std::size_t>(result.seconds);
    const std::size_t whole = std::min(seconds.size(), length); // the last second may be incomplete
    const std::size_t step = std::max<std::size_t>(1, (whole + kMostPoints - 1) / kMostPoints);
    for (std::size_t i = 0; i + step <= whole; i += step) {
        double sum = 0.0;
        double peak = 0.0;
        for (std::size_t k = i; k < i + step; ++k) {
            sum += value(seconds[k]);
            peak = std::max(peak, value(seconds[k]));
        }
        const double middle = static_cast<double>(i) + 0.5 * static_cast<double>(step);
        curve.points.push_back({middle, join == Join::kPeak ? peak : sum / static_cast<double>(step)});
    }
    return curve;
}

Markup time_charts(const LoadResult& result) {
    const double end = result.seconds;
    report::CurveChart frames{
        .title = "Frames per second", .note = "all clients of a group, over seconds", .end_x = end};
    report::CurveChart bytes{
        .title = "Megabytes per second", .note = "payload, over seconds", .digits = 2, .end_x = end};
    report::CurveChart due{
        .title = "Longest wait", .note = "from a due moment, over seconds", .unit = "ms", .end_x = end};
    for (std::size_t i = 0; i < result.groups.size(); ++i) {
        frames.curves.push_back(
            over_time(result, i, Join::kMean, [](const Second& each) { return static_cast<double>(each.frames); }));
        bytes.curves.push_back(over_time(result, i, Join::kMean,
                                         [](const Second& each) { return static_cast<double>(each.bytes) * 1e-6; }));
        due.curves.push_back(
            over_time(result, i, Join::kPeak, [](const Second& each) { return milliseconds(each.longest_due_us); }));
    }
    return report::side_by_side({curve_chart(frames), curve_chart(bytes), curve_chart(due)});
}

/// Percentiles over their number of nines, which stretches the tail.
Markup percentile_chart(const LoadResult& result, Stage stage) {
    const StageText& text = kStages[static_cast<std::size_t>(stage)];
    report::CurveChart chart{.title = std::string(text.name),
                             .note = std::string(text.meaning) + ", percentiles",
                             .unit = "ms",
                             .end_x = kMostNines,
                             .ticks = {{0.3, "50 %"}, {1.0, "90 %"}, {2.0, "99 %"}, {3.0, "99.9 %"}}};
    double most = 0.0;
    for (std::size_t i = 0; i < result.groups.size(); ++i) {
        report::Curve curve{.label = result.groups[i].group.name, .points = {}, .series = i % kSeries};
        for (const LatencyHistogram::Point& point : result.groups[i].tally.of(stage).curve()) {
            const double nines = point.share < 1.0 ? -std::log10(1.0 - point.share) : kMostNines;
            curve.points.push_back({std::min(nines, kMostNines), milliseconds(point.value_us)});
            most = std::max(most, curve.points.back().y);
        }
        chart.curves.push_back(std::move(curve));
    }
    chart.digits = most < 4.0 ? 2 : most < 40.0 ? 1 : 0;
    return curve_chart(chart);
}

Markup stage_table(const GroupResult& group) {
    report::Table table{.titles = {group.group.name + ", ms", "what", "count", "mean", "p50", "p90", "p95", "p99",
                                   "p99.9", "max"},
                        .rows = {}};
    for (std::size_t i = 0; i < kStageCount; ++i) {
        const LatencyHistogram& latencies = group.tally.stages[i];
        if (latencies.count() > 0) {
            table.rows.push_back({std::string(kStages[i].name), std::string(kStages[i].meaning),
                                  std::to_string(latencies.count()), fixed(latencies.mean_us() * 1e-3, 1),
                                  in_ms(latencies, 0.5), in_ms(latencies, 0.9), in_ms(latencies, 0.95),
                                  in_ms(latencies, 0.99), in_ms(latencies, 0.999), in_ms(latencies, 1.0)});
        }
    }
    return report::table(table);
}

/// Frame rates of the clients as sorted bars; a starved client is a short bar at the end.
Markup fairness_chart(const GroupResult& group) {
    constexpr std::size_t kMostBars = 24;
    std::vector<double> rates = group.client_fps;
    std::ranges::sort(rates, std::greater<>());
    report::BarChart chart{.title = group.group.name,
                           .note = "frames per second of each client; Jain's index " + fixed(group.fairness, 4),
                           .digits = 2,
                           .bars = {}};
    const std::size_t step = std::max<std::size_t>(1, (rates.size() + kMostBars - 1) / kMostBars);
    for (std::size_t i = 0; i < rates.size(); i += step) {
        chart.bars.push_back({.label = std::to_string(i + 1) + ".", .value = rates[i]});
    }
    if (!rates.empty() && (rates.size() - 1) % step != 0) {
        chart.bars.push_back({.label = std::to_string(rates.size()) + ".", .value = rates.back()});
    }
    return report::bar_chart(chart);
}

Markup metrics_table(const LoadResult& result) {
    report::Table table{.titles = {"metric", "before", "after", "change"}, .rows = {}};
    for (const auto& [name, after] : result.metrics_after) {
        const auto before = result.metrics_before.find(name);
        const bool is_known = before != result.metrics_before.end();
        if (!is_known || before->second != after) { // unchanged values are left out
            table.rows.push_back({name, is_known ? fixed(before->second, 3) : "–", fixed(after, 3),
                                  is_known ? fixed(after - before->second, 3) : "–"});
        }
    }
    return report::table(table);
}

Markup about(const LoadResult& result) {
    std::vector<std::pair<std::string, std::string>> entries{
        {"server", result.scenario.address},
        {"began", result.began_at},
        {"ramp", fixed(result.scenario.ramp.count(), 1) + " s"},
        {"this program", fixed(result.cpu_seconds, 2) + " CPU seconds, " + fixed(result.cpu_percent_per_client(), 2) +
                             " % of a core per client"}};
    for (const GroupResult& group : result.groups) {
        for (const auto& [reason, count] : group.tally.reasons) {
            entries.emplace_back(group.group.name, std::to_string(count) + " × " + reason);
        }
    }
    return report::definitions(entries);
}

} // namespace

std::string to_html(const LoadResult& result) {
    report::Page page("Load: " + result.scenario.name, lead(result));
    page.add_section("Groups", group_table(result));
    if (!result.checks.empty()) {
        page.add_section("Thresholds", check_table(result));
    }
    page.add_section("Over time", time_charts(result));
    std::vector<Markup> percentiles;
    for (const Stage stage : {Stage::kDue, Stage::kPose, Stage::kSend, Stage::kDecode}) {
        percentiles.push_back(percentile_chart(result, stage));
    }
    page.add_section("Latency", report::side_by_side(percentiles));
    Markup stages;
    std::vector<Markup> rates;
    for (const GroupResult& group : result.groups) {
        stages += stage_table(group);
        rates.push_back(fairness_chart(group));
    }
    page.add_section("Stages", stages);
    page.add_section("Fairness", report::side_by_side(rates));
    if (!result.metrics_after.empty()) {
        page.add_section("Metrics of the server", metrics_table(result));
    }
    page.add_section("About", about(result));
    return page.html();
}

} // namespace fieldcast::client::load
