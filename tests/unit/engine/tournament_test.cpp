// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The tournament against a search through all keys.
#include "vcg_core/engine/tournament.h"

#include <gtest/gtest.h>

#include <vector>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

int highest_by_search(const std::vector<double>& keys) {
    int best = -1;
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (keys[i] != Tournament::kNone && (best < 0 || keys[i] > keys[static_cast<std::size_t>(best)]))
            best = static_cast<int>(i);
    return best;
}

TEST(Tournament, FindsTheHighestAtEverySize) {
    Tournament tournament;
    for (int n = 1; n < 700; ++n) {
        tournament.resize(n);
        ASSERT_EQ(tournament.highest(), n == 1 ? -1 : n - 2) << n;
        tournament.set(n - 1, n);
        ASSERT_EQ(tournament.highest(), n - 1) << n;
    }
    for (int n = 699; n-- > 1;) {
        tournament.set(n, Tournament::kNone);
        ASSERT_EQ(tournament.highest(), n - 1);
    }
}

/// Few different keys, so that many are equal.
TEST(Tournament, FindsTheSmallestOfTheHighestWhileKeysRiseAndFall) {
    for (const int size : {1, 8, 9, 64, 65, 513, 600}) {
        Random random(5);
        Tournament tournament;
        tournament.resize(size);
        std::vector<double> keys(static_cast<std::size_t>(size), Tournament::kNone);
        for (int step = 0; step < 5000; ++step) {
            const std::uint32_t i = random.below(static_cast<std::uint32_t>(size));
            const std::uint32_t dice = random.below(12);
            const double key = dice == 0 ? Tournament::kNone : static_cast<double>(dice) - 6;
            tournament.set(static_cast<int>(i), key);
            keys[i] = key;
            ASSERT_EQ(tournament.key(static_cast<int>(i)), key);
            ASSERT_EQ(tournament.highest(), highest_by_search(keys)) << "step " << step << ", size " << size;
        }
    }
}

TEST(Tournament, RenumberedHasTheSameKeysUnderNewIndices) {
    Random random(8);
    Tournament tournament;
    tournament.resize(100);
    for (int i = 0; i < 100; ++i) tournament.set(i, random.unit());
    const Tournament before = tournament;
    std::vector<std::int32_t> order;
    for (int i = 0; i < 100; ++i) {
        if (i % 7 != before.highest() % 7) order.push_back(i * 37 % 100);
        if (i % 9 == 0) order.push_back(-1);
    }
    tournament.renumber(order);
    std::vector<double> keys;
    for (std::size_t i = 0; i < order.size(); ++i) {
        keys.push_back(order[i] < 0 ? Tournament::kNone : before.key(order[i]));
        EXPECT_EQ(tournament.key(static_cast<int>(i)), keys.back());
    }
    EXPECT_EQ(tournament.highest(), highest_by_search(keys));
}

}  // namespace
}  // namespace neuralmesh
