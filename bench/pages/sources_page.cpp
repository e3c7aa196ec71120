// SPDX-License-Identifier: Apache-2.0
#include "bench/pages/sources_page.h"

#include "bench/pages/result_page.h"
#include "bench/quality_table.h"
#include "report/chart.h"

#include <algorithm>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::pair<std::string, Json>>;

std::string lead_of(const Rows& rows) {
    const auto& [first, one] = rows.front();
    const auto& [last, many] = rows.back();
    const double longer = many["frame_ms"].get<double>() / std::max(one["frame_ms"].get<double>(), 1e-9);
    const double shift = many["rmse"].get<double>() / std::max(one["rmse"].get<double>(), 1e-9) - 1.0;
    return "With sources “" + last + "” a frame takes " + report::fixed(longer, 2) + " times as long as with “" +
           first + "”, and the error is " + report::fixed(100.0 * std::abs(shift), 1) + " % " +
           (shift > 0.0 ? "larger." : "smaller.");
}

report::Markup quality(const Rows& rows) {
    return report::side_by_side(
        {row_bars(rows, {}, {.title = "RMSE", .note = "less is better", .key = "rmse"}),
         row_bars(rows, {}, {.title = "SSIM", .note = "more is better", .key = "ssim", .digits = 3, .full = 1.0})});
}

report::Markup cost(const Rows& rows) {
    return report::side_by_side(
        {row_bars(rows, {}, {.title = "Frame", .key = "frame_ms", .digits = 0, .unit = " ms"}),
         row_bars(rows, {}, {.title = "Discards", .key = "discard_share", .digits = 2, .factor = 100.0, .unit = " %"}),
         row_bars(rows, {}, {.title = "Hole paths", .note = "per frame", .key = "hole_paths", .digits = 0})});
}

/// One measure of each view of the last frame, all configurations in one scale. Sources stand out by their values.
report::Markup maps_of(const Rows& rows, const char* measure, double factor, int digits) {
    std::vector<report::HeatMap> maps;
    for (const auto& [name, row] : rows) {
        report::HeatMap map{.title = name, .cols = 1, .values = {}, .digits = digits};
        for (const Json& view : row["views"]) {
            map.values.push_back(factor * view[measure].get<double>());
            map.cols = std::max(map.cols, view["col"].get<std::size_t>() + 1);
        }
        maps.push_back(map);
    }
    return report::heat_maps(std::move(maps));
}

report::Markup all_numbers(const Rows& rows) {
    report::Table table{.titles = {"sources", "RMSE", "SSIM", "RMSE of holes", "of reused", "discards", "path traced",
                                   "hole paths", "frame"},
                        .rows = {}};
    for (const auto& [name, row] : rows) {
        const auto percent = [&](const char* key) { return report::fixed(100.0 * row[key].get<double>(), 2) + " %"; };
        table.rows.push_back({name, number_text(row["rmse"], 4), number_text(row["ssim"], 4),
                              number_text(row["rmse_holes"], 4), number_text(row["rmse_reused"], 4),
                              percent("discard_share"), percent("traced_share"), number_text(row["hole_paths"], 0),
                              number_text(row["frame_ms"], 0) + " ms"});
    }
    return report::table(table);
}

} // namespace

report::Page sources_page(const Json& result) {
    Rows rows;
    for (const Json& row : result["sources"]) {
        rows.emplace_back(row["sources"].get<std::string>(), row);
    }
    report::Page page(result["scene"].get<std::string>() + ": choice of path traced views", lead_of(rows));
    page.add_section("Quality", quality(rows));
    page.add_section("Discards of each view, %", maps_of(rows, "discard_share", 100.0, 2));
    if (rows.front().second["views"].front().contains("ssim")) {
        page.add_section("SSIM of each view", maps_of(rows, "ssim", 1.0, 3));
        page.add_section("RMSE of each view", maps_of(rows, "rmse", 1.0, 4));
    }
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
