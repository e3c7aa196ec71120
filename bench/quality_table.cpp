// SPDX-License-Identifier: Apache-2.0
#include "bench/quality_table.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;

/// A column of a printed table.
struct Column {
    const char* title;
    const char* key;
    int digits;
    double factor = 1.0;
    const char* unit = "";
};

void print_columns(std::ostream& stream, const std::vector<std::pair<std::string, Json>>& rows,
                   const std::vector<Column>& columns) {
    stream << '\n' << std::left << std::setw(14) << "input" << std::right;
    for (const Column& column : columns) {
        stream << std::setw(10) << column.title;
    }
    for (const auto& [name, row] : rows) {
        stream << '\n' << std::left << std::setw(14) << name << std::right;
        for (const Column& column : columns) {
            const Json& value = row.at(column.key);
            const Json scaled = value.is_null() ? value : Json(value.get<double>() * column.factor);
            stream << std::setw(10) << number_text(scaled, column.digits) + (value.is_null() ? "" : column.unit);
        }
    }
    stream << '\n';
}

/// The part `part` of all rows that have it.
std::vector<std::pair<std::string, Json>> parts(const Json& rows, const char* part) {
    std::vector<std::pair<std::string, Json>> found;
    for (const auto& [name, row] : rows.items()) {
        if (row.contains(part)) {
            found.emplace_back(name, row[part]);
        }
    }
    return found;
}

void print_views(std::ostream& stream, const std::string& name, const Json& light_field) {
    stream << "\nSSIM of the views, " << name << ":";
    for (const Json& view : light_field["views"]) {
        stream << (view["col"] == 0 ? "\n  " : "") << std::setw(8) << number_text(view["ssim"], 3);
    }
    stream << '\n';
}

} // namespace

std::string number_text(const Json& value, int digits) {
    if (value.is_null()) {
        return "-";
    }
    std::ostringstream stream;
    stream << std::fixed << std::setprecision(digits) << value.get<double>();
    return stream.str();
}

void print_quality_table(std::ostream& stream, const Json& result) {
    std::vector<std::pair<std::string, Json>> rows;
    for (const auto& [name, row] : result["rows"].items()) {
        rows.emplace_back(name, row);
    }
    print_columns(stream, rows,
                  {{"RMSE", "rmse", 4},
                   {"SSIM", "ssim", 4},
                   {"RMSE*", "rmse_without_noise", 4},
                   {"SSIM*", "ssim_without_noise", 4},
                   {"relMSE", "relative_mse", 4},
                   {"holes", "rmse_holes", 4},
                   {"reused", "rmse_reused", 4},
                   {"border", "rmse_border", 4},
                   {"moving", "rmse_moving", 4},
                   {"discards", "discard_share", 2, 100.0, " %"},
                   {"traced", "traced_share", 2, 100.0, " %"},
                   {"frame", "frame_ms", 0, 1.0, " ms"}});
    stream << "* estimated without the noise of the references\n";
    if (const auto temporal = parts(result["rows"], "temporal"); !temporal.empty()) {
        print_columns(stream, temporal,
                      {{"warped", "warped_error", 4}, {"excess", "warped_error_excess", 4}, {"flicker", "flicker", 4}});
    }
    if (const auto light_fields = parts(result["rows"], "light_field"); !light_fields.empty()) {
        print_columns(stream, light_fields,
                      {{"angular", "angular_error", 4},
                       {"EPI SSIM", "epi_ssim", 4},
                       {"refocused", "refocus_rmse", 4},
                       {"its SSIM", "refocus_ssim", 4}});
        print_views(stream, light_fields.back().first, light_fields.back().second);
    }
}

Json csv_origin_with_size(const Json& result) {
    return {{"machine", result["processor"].get<std::string>() + "; " + result["device"].get<std::string>()},
            {"commit", result["commit"]},
            {"command", result["command"]},
            {"scene", result["scene"]},
            {"size", result["size"]}};
}

Json csv_origin(const Json& result) {
    Json origin = csv_origin_with_size(result);
    origin.erase("size");
    origin["protocol"] = result["protocol"].get<std::string>() + " " + result["size"].get<std::string>() +
                         ", references of " + result["reference_samples"].dump() + " samples";
    return origin;
}

const std::vector<std::string>& quality_columns() {
    static const std::vector<std::string> columns{
        "machine",  "commit",        "command",      "scene",         "protocol",     "input",
        "rmse",     "ssim",          "relative_mse", "rmse_holes",    "rmse_reused",  "rmse_border",
        "frame_ms", "traced_share",  "rmse_moving",  "discard_share", "warped_error", "warped_error_excess",
        "flicker",  "angular_error", "epi_ssim",     "refocus_rmse",  "refocus_ssim", "flip",
        "rmse_without_noise", "ssim_without_noise"};
    return columns;
}

std::vector<Json> quality_csv_rows(const Json& result) {
    std::vector<Json> lines;
    for (const auto& [name, row] : result["rows"].items()) {
        Json line = csv_origin(result);
        line["input"] = name;
        line.update(row);
        for (const char* part : {"temporal", "light_field"}) {
            if (row.contains(part)) {
                Json values = row[part];
                values.erase("rmse"); // the row has its own value
                values.erase("ssim");
                line.update(values);
            }
        }
        lines.push_back(line);
    }
    return lines;
}

} // namespace fieldcast::bench
