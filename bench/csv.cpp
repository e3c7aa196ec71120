// SPDX-License-Identifier: Apache-2.0
#include "bench/csv.h"

#include "core/base/error.h"
#include "core/image/atomic_file.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <sstream>
#include <system_error>

namespace fieldcast::bench {

namespace {

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) {
        return text;
    }
    std::string result;
    result += '"';
    for (const char c : text) {
        result.append(c == '"' ? 2 : 1, c);
    }
    result += '"';
    return result;
}

std::string line(const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        text += i > 0 ? "," : "";
        text += cells[i];
    }
    text += '\n';
    return text;
}

} // namespace

std::string csv_cell(const nlohmann::ordered_json& value) {
    if (value.is_null()) {
        return {};
    }
    if (value.is_number_float()) {
        std::ostringstream stream;
        stream.precision(6);
        stream << value.get<double>();
        return stream.str();
    }
    return quoted(value.is_string() ? value.get<std::string>() : value.dump());
}

std::vector<nlohmann::ordered_json> csv_rows(const nlohmann::ordered_json& first, const nlohmann::ordered_json& rows) {
    std::vector<nlohmann::ordered_json> lines;
    for (const nlohmann::ordered_json& row : rows) {
        lines.push_back(first);
        lines.back().update(row);
    }
    return lines;
}

void write_csv(const std::string& file, const std::vector<std::string>& columns,
               const std::vector<nlohmann::ordered_json>& rows) {
    std::vector<std::string> cells;
    std::ranges::transform(columns, std::back_inserter(cells), quoted);
    std::string text = line(cells);
    for (const nlohmann::ordered_json& row : rows) {
        cells.clear();
        for (const std::string& column : columns) {
            const auto found = row.find(column);
            cells.push_back(found != row.end() ? csv_cell(*found) : std::string());
        }
        text += line(cells);
    }
    try {
        image::write_file_atomically(file, std::as_bytes(std::span(text)));
    } catch (const std::system_error& error) {
        throw UserError(file + ": cannot be written: " + error.code().message());
    }
}

} // namespace fieldcast::bench
