// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fieldcast::bench {

/// One cell: texts in quotes where they need them (RFC 4180), numbers with six significant digits, nothing for null.
std::string csv_cell(const nlohmann::ordered_json& value);

/// A table with a line of titles. A row is an object; members that are missing stay empty, others are left out.
/// Throws UserError if the file cannot be written; an old one is then kept.
void write_csv(const std::string& file, const std::vector<std::string>& columns,
               const std::vector<nlohmann::ordered_json>& rows);

} // namespace fieldcast::bench
