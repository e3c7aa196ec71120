// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/page.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace fieldcast::bench {

// Parts that the pages of all results share.

/// Bars of one number, `key`, of each row; `rows` are pairs of a name and an object. `highlighted` is the emphasised
/// row.
struct RowBars {
    std::string title;
    std::string note{};
    std::string key;
    int digits = 4;
    double factor = 1.0;
    std::string unit{};
    std::optional<double> full{}; ///< value of a bar of full length
};
report::Markup row_bars(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& rows,
                        const std::string& highlighted, const RowBars& bars);

/// Members of a JSON object, in their order.
std::vector<std::pair<std::string, nlohmann::ordered_json>> members_of(const nlohmann::ordered_json& object);

/// A section with processor, device, commit, command and further facts of a result, for the end of its page.
report::Markup origin(const nlohmann::ordered_json& result,
                      const std::vector<std::pair<std::string, std::string>>& further);

} // namespace fieldcast::bench
