// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fieldcast::scene {

struct AliasEntry {
    float accept = 1.0F;     ///< draw the entry's own index if u < accept
    std::uint32_t alias = 0; ///< index drawn otherwise
    float probability = 0.0F;
};

/// Table for drawing index i with probability weights[i] / sum in constant time. Weights ≥ 0; if all are 0, all
/// probabilities are 0. M. Vose. A Linear Algorithm for Generating Random Numbers with a Given Distribution. 1991.
std::vector<AliasEntry> make_alias_table(std::span<const double> weights);

} // namespace fieldcast::scene
