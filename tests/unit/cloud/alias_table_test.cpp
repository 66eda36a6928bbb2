// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/alias_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace neuralmesh {
namespace {

/// How often each number is drawn.
std::vector<int> drawn(const std::vector<double>& weights, int draws) {
    const AliasTable table(weights);
    Random random(5);
    std::vector<int> counts(weights.size());
    for (int i = 0; i < draws; ++i) ++counts[table.draw(random)];
    return counts;
}

TEST(AliasTable, DrawsInProportionToTheWeights) {
    const std::vector<std::vector<double>> cases = {{1},
                                                    {1, 1, 1},
                                                    {1, 2, 3, 4},
                                                    {1e-6, 1, 1e-6, 5},
                                                    {100, 1, 1, 1, 1, 1},
                                                    std::vector<double>(1000, 0.3)};
    for (const std::vector<double>& weights : cases) {
        constexpr int kDraws = 400000;
        const std::vector<int> counts = drawn(weights, kDraws);
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const double expected = kDraws * weights[i] / sum;
            EXPECT_NEAR(counts[i], expected, 5 * std::sqrt(expected) + 2) << i << " of " << weights.size();
        }
    }
}

TEST(AliasTable, RandomWeightsKeepTheirShares) {
    Random random(1);
    std::vector<double> weights;
    for (int i = 0; i < 500; ++i) weights.push_back(std::pow(10, 3 * static_cast<double>(random.unit())));
    const std::vector<int> counts = drawn(weights, 1000000);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double expected = 1e6 * weights[i] / sum;
        EXPECT_NEAR(counts[i], expected, 5 * std::sqrt(expected) + 2);
    }
}

TEST(AliasTable, IsEmptyWithoutWeights) {
    EXPECT_TRUE(AliasTable().empty());
    EXPECT_FALSE(AliasTable({1.0}).empty());
}

}  // namespace
}  // namespace neuralmesh
