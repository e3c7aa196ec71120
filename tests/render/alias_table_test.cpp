// SPDX-License-Identifier: Apache-2.0
#include "core/scene/alias_table.h"

#include <gmock/gmock.h>
#include <numeric>
#include <random>

namespace fieldcast::scene {
namespace {

/// Probability with which each index is drawn, summed exactly over the table.
std::vector<double> drawn(const std::vector<AliasEntry>& table) {
    std::vector<double> shares(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double accept = static_cast<double>(std::min(table[i].accept, 1.0F));
        shares[i] += accept / static_cast<double>(table.size());
        shares[table[i].alias] += (1.0 - accept) / static_cast<double>(table.size());
    }
    return shares;
}

TEST(AliasTable, DrawsEveryIndexWithItsProbability) {
    std::mt19937 random(1);
    std::exponential_distribution<double> weight(1.0);
    std::vector<double> weights(1000);
    std::ranges::generate(weights, [&] { return weight(random); });
    weights[17] = 0.0;
    weights[500] = 400.0; // one dominant weight, like a sun
    const auto table = make_alias_table(weights);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const auto shares = drawn(table);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        // `accept` is a float: each of at most 1000 cells errs by 6e-8 of its share.
        EXPECT_NEAR(shares[i], weights[i] / sum, 1e-7) << i;
        EXPECT_FLOAT_EQ(table[i].probability, static_cast<float>(weights[i] / sum)) << i;
    }
}

TEST(AliasTable, NeverDrawsWeightZero) {
    const auto table = make_alias_table(std::vector<double>{0.0, 3.0, 0.0, 1.0});
    EXPECT_THAT(drawn(table), testing::ElementsAre(0.0, testing::DoubleEq(0.75), 0.0, testing::DoubleEq(0.25)));
}

TEST(AliasTable, HasNoProbabilitiesWithoutWeights) {
    for (const AliasEntry& entry : make_alias_table(std::vector<double>{0.0, 0.0})) {
        EXPECT_EQ(entry.probability, 0.0F);
    }
    EXPECT_TRUE(make_alias_table({}).empty());
}

} // namespace
} // namespace fieldcast::scene
