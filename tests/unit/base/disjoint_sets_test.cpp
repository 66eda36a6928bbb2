// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Disjoint sets against labels that are rewritten whole.
#include "vcg_core/base/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

TEST(DisjointSets, AreThoseOfLabelsRewrittenAtEachJoin) {
    constexpr std::uint32_t kCount = 60;
    Random random(1);
    DisjointSets sets(kCount);
    std::vector<int> least(kCount);  // of the set of each number
    std::iota(least.begin(), least.end(), 0);
    for (int step = 0; step < 100; ++step) {
        const auto a = random.below(kCount), b = random.below(kCount);
        const int low = std::min(least[a], least[b]), high = std::max(least[a], least[b]);
        EXPECT_EQ(sets.join(static_cast<int>(a), static_cast<int>(b)), low != high);
        for (int& label : least) label = label == high ? low : label;
        for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(sets.find(static_cast<int>(i)), least[i]);
    }
}

}  // namespace
}  // namespace neuralmesh
