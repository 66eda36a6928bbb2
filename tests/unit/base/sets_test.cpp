// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Sets and queues against plain ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "vcg_core/base/cheapest_first.h"
#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

// Disjoint sets against labels that are rewritten whole.

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

/// The cost that something had when it had changed so many times.
struct Entry {
    double cost = 0;
    int id = 0;
    int changes = 0;

    bool operator<(const Entry& other) const { return std::tie(cost, id) < std::tie(other.cost, other.id); }
};

TEST(CheapestFirst, TakesWhatAPlainSetTakes) {
    constexpr int kCount = 5000;
    Random random(1);
    std::vector<int> changes(kCount, 0);
    CheapestFirst<Entry> queue;
    std::set<std::pair<double, int>> plain;
    std::vector<double> cost_of(kCount, 0);
    const auto push = [&](int id, double cost) {
        plain.erase({cost_of[static_cast<std::size_t>(id)], id});
        cost_of[static_cast<std::size_t>(id)] = cost;
        plain.insert({cost, id});
        queue.push({cost, id, ++changes[static_cast<std::size_t>(id)]});
    };
    const auto is_current = [&](const Entry& entry) {
        return changes[static_cast<std::size_t>(entry.id)] == entry.changes;
    };
    for (int id = 0; id < kCount; ++id) push(id, random.below(1000));
    Entry entry;
    int taken = 0;
    while (queue.pop(entry, is_current)) {
        ASSERT_FALSE(plain.empty());
        ASSERT_EQ(*plain.begin(), std::pair(entry.cost, entry.id)) << taken;
        plain.erase(plain.begin());
        ++changes[static_cast<std::size_t>(entry.id)];
        // Others change, or come again, some of them cheaper than what was taken.
        for (int i = 0; ++taken < 20000 && i < 3; ++i)
            push(static_cast<int>(random.below(kCount)), entry.cost - 20 + random.below(200));
    }
    EXPECT_GT(taken, 20000);
    EXPECT_TRUE(plain.empty());
    EXPECT_FALSE(queue.pop(entry, is_current));
    queue.push({0, 1, changes[1]});
    EXPECT_TRUE(queue.pop(entry, is_current));
    EXPECT_EQ(entry.id, 1);
}

}  // namespace
}  // namespace neuralmesh
