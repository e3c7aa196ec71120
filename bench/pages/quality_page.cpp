// SPDX-License-Identifier: Apache-2.0
#include "bench/pages/quality_page.h"

#include "bench/pages/result_page.h"
#include "bench/quality_table.h"
#include "core/image/correspondence.h"
#include "core/image/metrics.h"
#include "report/chart.h"
#include "report/picture.h"

#include <algorithm>
#include <cmath>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::pair<std::string, Json>>;

constexpr std::uint32_t kCropWidth = 320;
constexpr std::uint32_t kCropHeight = 180;
constexpr float kLargestError = 0.25F; // of error maps

/// The row to emphasise: "default", or the last one.
std::string highlighted_row(const Rows& rows) {
    const auto ours = std::ranges::find(rows, "default", [](const auto& row) { return row.first; });
    return ours != rows.end() ? ours->first : rows.back().first;
}

std::string lead_of(const Json& result, const Rows& rows, const std::string& highlighted) {
    const Json& row = result["rows"][highlighted];
    const double noisy = rows.front().second["rmse"].get<double>();
    return highlighted + " has a root mean squared error of " + number_text(row["rmse"], 4) + ", " +
           report::fixed(row["rmse"].get<double>() / noisy, 2) + " of that of " + rows.front().first +
           ", and a structural similarity of " + number_text(row["ssim"], 3) + " with references of " +
           result["reference_samples"].dump() + " samples per pixel.";
}

report::Markup errors(const Rows& rows, const std::string& highlighted) {
    std::vector<report::Markup> figures{
        row_bars(rows, highlighted, {.title = "RMSE", .note = "less is better", .key = "rmse"}),
        row_bars(rows, highlighted, {.title = "SSIM", .note = "1 is equal", .key = "ssim", .full = 1.0})};
    if (rows.front().second.contains("flip")) {
        figures.push_back(row_bars(rows, highlighted, {.title = "FLIP", .note = "less is better", .key = "flip"}));
    }
    return report::side_by_side(figures);
}

report::Markup parts(const Rows& rows, const std::string& highlighted) {
    std::vector<report::Markup> figures;
    for (const auto& [key, title, note] : {std::tuple("rmse_reused", "Reused pixels", "the source shows them"),
                                           std::tuple("rmse_holes", "Holes", "the source does not"),
                                           std::tuple("rmse_border", "Border", "32 pixels wide"),
                                           std::tuple("rmse_moving", "Moving objects", "and their surroundings")}) {
        const bool is_known = std::ranges::any_of(rows, [&](const auto& row) { return !row.second[key].is_null(); });
        if (is_known) {
            figures.push_back(row_bars(rows, highlighted, {.title = title, .note = note, .key = key}));
        }
    }
    return report::side_by_side(figures);
}

/// Rows of one part of the result ("temporal"); those that lack it are left out.
Rows part_of(const Rows& rows, const char* part) {
    Rows found;
    for (const auto& [name, row] : rows) {
        if (row.contains(part)) {
            found.emplace_back(name, row[part]);
        }
    }
    return found;
}

report::Markup steadiness(const Rows& rows, const std::string& highlighted) {
    return report::side_by_side(
        {row_bars(rows, highlighted, {.title = "Warped error", .note = "change beside motion", .key = "warped_error"}),
         row_bars(rows, highlighted,
                  {.title = "Excess", .note = "over the references' own", .key = "warped_error_excess"}),
         row_bars(rows, highlighted, {.title = "Flicker", .note = "nothing moves", .key = "flicker"})});
}

report::Markup refocus(const Rows& rows) {
    report::LineChart chart{.title = "RMSE when refocused", .note = "by focal depth", .points = {}, .lines = {}};
    for (const Json& focus : rows.front().second["refocus"]) {
        chart.points.push_back(focus["depth_m"].is_null() ? "∞" : number_text(focus["depth_m"], 1) + " m");
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        report::Line line{.label = rows[i].first, .values = {}, .series = (i + 5) % 8}; // the noisy input is grey
        for (const Json& focus : rows[i].second["refocus"]) {
            line.values.push_back(focus["rmse"].get<double>());
        }
        chart.lines.push_back(line);
    }
    return report::line_chart(chart);
}

report::Markup light_field(const Rows& rows, const std::string& highlighted) {
    std::vector<report::Markup> figures{
        row_bars(rows, highlighted, {.title = "Angular error", .note = "between neighbours", .key = "angular_error"}),
        row_bars(rows, highlighted, {.title = "EPI SSIM", .note = "epipolar slices", .key = "epi_ssim", .full = 1.0}),
        refocus(rows)};
    for (const auto& [name, part] : rows) {
        if (name == rows.front().first) {
            continue; // alike in all views
        }
        report::HeatMap map{.title = "SSIM of each view, " + name, .values = {}};
        for (const Json& view : part["views"]) {
            map.cols = std::max(map.cols, view["col"].get<std::size_t>() + 1);
            map.values.push_back(view["ssim"].get<double>());
        }
        const auto [low, high] = std::ranges::minmax(map.values);
        map.low = low;
        map.high = high;
        figures.push_back(report::heat_map(map));
    }
    return report::side_by_side(figures);
}

report::Markup all_numbers(const Rows& rows, const std::string& highlighted) {
    report::Table table{.titles = {"input", "RMSE", "SSIM", "RMSE*", "SSIM*", "relMSE", "holes", "reused", "border",
                                   "moving", "discards", "path traced", "frame"},
                        .rows = {}};
    for (const auto& [name, row] : rows) {
        const auto percent = [&](const char* key) {
            return row[key].is_null() ? "–" : report::fixed(100.0 * row[key].get<double>(), 2) + " %";
        };
        table.highlighted = name == highlighted ? table.rows.size() : table.highlighted;
        table.rows.push_back({name, number_text(row["rmse"], 4), number_text(row["ssim"], 4),
                              number_text(row["rmse_without_noise"], 4), number_text(row["ssim_without_noise"], 4),
                              number_text(row["relative_mse"], 4), number_text(row["rmse_holes"], 4),
                              number_text(row["rmse_reused"], 4), number_text(row["rmse_border"], 4),
                              number_text(row["rmse_moving"], 4), percent("discard_share"), percent("traced_share"),
                              row["frame_ms"].is_null() ? "–" : number_text(row["frame_ms"], 0) + " ms"});
    }
    return report::table(table);
}

report::Markup meanings() {
    return report::definitions(
        {{"RMSE", "Root mean squared error of display-referred values (0 … 1); mean over pictures."},
         {"SSIM", "Structural similarity (Wang et al. 2004) of the luma; mean over pictures."},
         {"RMSE*, SSIM*", "Estimated values against references without noise, from the two halves of their "
                          "samples."},
         {"relMSE", "Squared error over squared reference, of linear values; a few dark pixels can carry it."},
         {"holes, reused, border, moving",
          "RMSE over those pixels only: not shown by the source; shown by it; within 32 "
          "pixels of the border; at or near moving objects."},
         {"discards, path traced", "Pixels of synthesised views that could not be reused, and that were path traced."},
         {"1 spp", "The same views path traced with one sample per pixel, nothing reused."},
         {"More", "docs/benchmarks.md of the project."}});
}

void add_pictures(report::Page& page, const Json& result, const ShownPictures& shown, const std::string& highlighted) {
    const auto exposure = result["exposure"].get<float>();
    const auto linear_of = [&](const std::string& name) -> const image::RgbF32& {
        return std::ranges::find(shown.pictures, name, &NamedPicture::name)->linear;
    };
    const image::RgbF32 reference = image::display_image(linear_of(kReferenceName), exposure);
    const auto error_of = [&](const image::RgbF32& display) { return image::error_image(display, reference); };
    const report::Crop crop =
        report::worst_crop(error_of(image::display_image(linear_of(highlighted), exposure)), kCropWidth, kCropHeight);
    std::vector<report::Picture> pictures;
    std::vector<report::Picture> maps;
    for (const NamedPicture& picture : shown.pictures) {
        const image::RgbF32 display = image::display_image(picture.linear, exposure);
        if (picture.name == kReferenceName) {
            continue;
        }
        pictures.push_back({picture.name,
                            "RMSE " + report::fixed(image::rmse(display, reference), 4) + ", SSIM " +
                                report::fixed(image::ssim(display, reference), 3),
                            report::cropped(display, crop)});
        maps.push_back({"error of " + picture.name, "",
                        report::error_map(report::cropped(error_of(display), crop), kLargestError)});
    }
    pictures.push_back(
        {kReferenceName, result["reference_samples"].dump() + " samples per pixel", report::cropped(reference, crop)});
    maps.front().begins_row = true;
    pictures.insert(pictures.end(), maps.begin(), maps.end());
    const ViewIndex index = view_index(shown.id.position);
    const bool is_part = !(crop == report::Crop{0, 0, reference.width_px, reference.height_px});
    report::Markup content = report::paragraph(
        "View (" + std::to_string(index.row) + ", " + std::to_string(index.col) + ") of 6×6 in frame " +
        std::to_string(shown.id.frame) + (is_part ? ", the part where " + highlighted + " errs most" : "") +
        ". Choose a picture and press the arrow keys to see what changes in place.");
    content += report::compare_pictures(page, pictures);
    content += report::error_scale(kLargestError);
    page.add_section("Pictures", content);
}

} // namespace

report::Page quality_page(const Json& result, const ShownPictures& shown) {
    const Rows rows = members_of(result["rows"]);
    const std::string highlighted = highlighted_row(rows);
    report::Page page(result["scene"].get<std::string>() + ": quality of views", lead_of(result, rows, highlighted));
    page.add_section("Errors", errors(rows, highlighted));
    if (!shown.pictures.empty()) {
        add_pictures(page, result, shown, highlighted);
    }
    page.add_section("Errors by region", parts(rows, highlighted));
    if (const Rows temporal = part_of(rows, "temporal"); !temporal.empty()) {
        page.add_section("Over time", steadiness(temporal, highlighted));
    }
    if (const Rows fields = part_of(rows, "light_field"); !fields.empty()) {
        page.add_section("As a light field", light_field(fields, highlighted));
    }
    page.add_section("All numbers", all_numbers(rows, highlighted));
    page.add_section("Definitions", meanings());
    page.add_section("Measurement",
                     origin(result, {{"protocol", result["protocol"].get<std::string>() + ", " +
                                                      result["size"].get<std::string>() + " pixels"},
                                     {"references", result["reference_samples"].dump() + " samples per pixel"},
                                     {"views rendered", result["rendered_views"].get<std::string>()},
                                     {"exposure", number_text(result["exposure"], 3)}}));
    return page;
}

} // namespace fieldcast::bench
