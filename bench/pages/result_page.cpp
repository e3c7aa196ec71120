// SPDX-License-Identifier: Apache-2.0
#include "bench/pages/result_page.h"

#include "report/chart.h"

namespace fieldcast::bench {

using Json = nlohmann::ordered_json;

report::Markup row_bars(const std::vector<std::pair<std::string, Json>>& rows, const std::string& highlighted,
                        const RowBars& bars) {
    report::BarChart chart{.title = bars.title,
                           .note = bars.note,
                           .digits = bars.digits,
                           .unit = bars.unit,
                           .full = bars.full,
                           .bars = {}};
    for (const auto& [name, row] : rows) {
        const auto found = row.find(bars.key);
        const bool is_known = found != row.end() && !found->is_null();
        chart.bars.push_back({.label = name,
                              .value = is_known ? std::optional(found->get<double>() * bars.factor) : std::nullopt,
                              .is_highlighted = name == highlighted});
    }
    return report::bar_chart(chart);
}

std::vector<std::pair<std::string, Json>> members_of(const Json& object) {
    std::vector<std::pair<std::string, Json>> members;
    for (const auto& [name, value] : object.items()) {
        members.emplace_back(name, value);
    }
    return members;
}

report::Markup origin(const Json& result, const std::vector<std::pair<std::string, std::string>>& further) {
    std::vector<std::pair<std::string, std::string>> entries = further;
    for (const char* key : {"processor", "device", "commit", "command", "finished"}) {
        if (result.contains(key)) {
            entries.emplace_back(key, result[key].get<std::string>());
        }
    }
    return report::definitions(entries);
}

} // namespace fieldcast::bench
