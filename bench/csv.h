// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fieldcast::bench {

/// Text of one cell: strings, quoted where RFC 4180 requires it; numbers with six significant digits; nothing for null.
std::string csv_cell(const nlohmann::ordered_json& value);

/// One row per element of `rows`: the members of `first`, then its own.
std::vector<nlohmann::ordered_json> csv_rows(const nlohmann::ordered_json& first, const nlohmann::ordered_json& rows);

/// Writes a table with a line of titles. A row is an object; missing members stay empty, members without a column are
/// left out. Throws UserError if the file cannot be written; an old file is then kept.
void write_csv(const std::string& file, const std::vector<std::string>& columns,
               const std::vector<nlohmann::ordered_json>& rows);

} // namespace fieldcast::bench
