// SPDX-License-Identifier: Apache-2.0
#include "bench/pages/grids_page.h"

#include "bench/pages/result_page.h"
#include "bench/quality_table.h"
#include "report/chart.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::pair<std::string, Json>>;

std::string lead_of(const Json& result) {
    const double lost = result["ssim_lost"].get<double>();
    const std::string change = std::abs(lost) < 5e-5 ? "does not change" : lost > 0.0 ? "falls" : "rises";
    return "From " + result["grids"].front()["grid"].get<std::string>() + " to " +
           result["grids"].back()["grid"].get<std::string>() + " views, the mean structural similarity " + change +
           (std::abs(lost) < 5e-5 ? std::string() : " by " + report::fixed(std::abs(lost), 4)) +
           ". Every view of every grid was compared with its reference.";
}

report::Markup quality(const Rows& rows) {
    report::LineChart chart{
        .title = "SSIM", .note = "mean over all views, and the worst view", .points = {}, .lines = {}};
    chart.lines = {{.label = "mean", .values = {}, .series = 0}, {.label = "worst view", .values = {}, .series = 1}};
    for (const auto& [name, row] : rows) {
        chart.points.push_back(name);
        chart.lines[0].values.push_back(row["ssim"].get<double>());
        chart.lines[1].values.push_back(row["ssim_min"].get<double>());
    }
    return report::side_by_side(
        {report::line_chart(chart), row_bars(rows, {}, {.title = "RMSE", .note = "less is better", .key = "rmse"})});
}

report::Markup cost(const Rows& rows) {
    return report::side_by_side(
        {row_bars(rows, {}, {.title = "Frame", .key = "frame_ms", .digits = 0, .unit = " ms"}),
         row_bars(rows, {}, {.title = "Discards", .key = "discard_share", .digits = 2, .factor = 100.0, .unit = " %"}),
         row_bars(rows, {}, {.title = "Hole paths", .note = "per frame", .key = "hole_paths", .digits = 0})});
}

/// SSIM of each view, mean over frames, all grids in one scale.
report::Markup views(const Rows& rows) {
    std::vector<report::HeatMap> maps;
    for (const auto& [name, row] : rows) {
        std::map<std::pair<int, int>, std::pair<double, double>> sums; // by row and column: SSIM, frames
        std::size_t cols = 1;
        for (const Json& view : row["views"]) {
            auto& sum = sums[{view["row"].get<int>(), view["col"].get<int>()}];
            sum.first += view["ssim"].get<double>();
            sum.second += 1.0;
            cols = std::max(cols, view["col"].get<std::size_t>() + 1);
        }
        report::HeatMap map{.title = name, .cols = cols, .values = {}};
        for (const auto& [place, sum] : sums) {
            map.values.push_back(sum.first / sum.second);
        }
        maps.push_back(map);
    }
    return report::heat_maps(std::move(maps));
}

report::Markup all_numbers(const Rows& rows) {
    report::Table table{.titles = {"grid", "RMSE", "SSIM", "worst view", "SSIM*", "RMSE of holes", "of reused",
                                   "discards", "path traced", "hole paths", "frame"},
                        .rows = {}};
    for (const auto& [name, row] : rows) {
        const auto percent = [&](const char* key) { return report::fixed(100.0 * row[key].get<double>(), 2) + " %"; };
        table.rows.push_back({name, number_text(row["rmse"], 4), number_text(row["ssim"], 4),
                              number_text(row["ssim_min"], 4), number_text(row["ssim_without_noise"], 4),
                              number_text(row["rmse_holes"], 4), number_text(row["rmse_reused"], 4),
                              percent("discard_share"), percent("traced_share"),
                              number_text(row["hole_paths"], 0), number_text(row["frame_ms"], 0) + " ms"});
    }
    return report::table(table);
}

} // namespace

report::Page grids_page(const Json& result) {
    Rows rows;
    for (const Json& row : result["grids"]) {
        rows.emplace_back(row["grid"].get<std::string>(), row);
    }
    report::Page page(result["scene"].get<std::string>() + ": quality by size of the grid", lead_of(result));
    page.add_section("Quality", quality(rows));
    page.add_section("SSIM of each view", views(rows));
    page.add_section("Cost", cost(rows));
    page.add_section("All numbers", all_numbers(rows));
    page.add_section(
        "Measurement",
        origin(result, {{"views made by", result["preset"].get<std::string>()},
                        {"protocol", result["protocol"].get<std::string>() + ", " + result["size"].get<std::string>() +
                                         " pixels, frames " + result["frames"].dump()},
                        {"references", result["reference_samples"].dump() + " samples per pixel"},
                        {"exposure", number_text(result["exposure"], 3)}}));
    return page;
}

} // namespace fieldcast::bench
