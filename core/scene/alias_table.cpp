// SPDX-License-Identifier: Apache-2.0
#include "core/scene/alias_table.h"

#include <numeric>

namespace fieldcast::scene {

std::vector<AliasEntry> make_alias_table(std::span<const double> weights) {
    std::vector<AliasEntry> table(weights.size());
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(sum > 0.0)) {
        return table;
    }
    std::vector<double> scaled(weights.size());
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        table[i].alias = i;
        table[i].probability = static_cast<float>(weights[i] / sum);
        scaled[i] = weights[i] / sum * static_cast<double>(weights.size());
        (scaled[i] < 1.0 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t low = small.back();
        small.pop_back();
        const std::uint32_t high = large.back();
        table[low].accept = static_cast<float>(scaled[low]);
        table[low].alias = high;
        scaled[high] -= 1.0 - scaled[low];
        if (scaled[high] < 1.0) {
            large.pop_back();
            small.push_back(high);
        }
    }
    return table;
}

} // namespace fieldcast::scene
