// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace fieldcast::bench {

/// A number with `digits` decimals, or a dash for null.
std::string number_text(const nlohmann::ordered_json& value, int digits);

/// The table of a result of `quality` for a terminal: errors; then what was measured over time and over views.
void print_quality_table(std::ostream& stream, const nlohmann::ordered_json& result);

/// The first columns of every CSV of a result: machine, commit, command, scene, protocol.
nlohmann::ordered_json csv_origin(const nlohmann::ordered_json& result);

/// Columns of its CSV, and its lines: one per row of the table.
const std::vector<std::string>& quality_columns();
std::vector<nlohmann::ordered_json> quality_csv_rows(const nlohmann::ordered_json& result);

} // namespace fieldcast::bench
