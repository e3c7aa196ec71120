// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace fieldcast::bench {

/// A number with `digits` decimals, or a dash for null.
std::string number_text(const nlohmann::ordered_json& value, int digits);

/// Prints the table of a result of `quality` for a terminal: errors, then measures over time and over views.
void print_quality_table(std::ostream& stream, const nlohmann::ordered_json& result);

/// The first columns of the CSV of any result: machine, commit, command, scene, protocol.
nlohmann::ordered_json csv_origin(const nlohmann::ordered_json& result);

/// The same for results of one size: machine, commit, command, scene, size.
nlohmann::ordered_json csv_origin_with_size(const nlohmann::ordered_json& result);

/// Columns and lines of the CSV of `quality`; one line per row of the table.
const std::vector<std::string>& quality_columns();
std::vector<nlohmann::ordered_json> quality_csv_rows(const nlohmann::ordered_json& result);

} // namespace fieldcast::bench
