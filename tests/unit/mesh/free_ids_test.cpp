// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/free_ids.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

TEST(FreeIds, TakeReturnsEachIdOnce) {
    FreeIds ids;
    std::set<int> expected;
    Random random(2);
    for (int round = 0; round < 20000; ++round) {
        const auto id = static_cast<int>(random.below(3000));
        if (random.below(2) == 0) {
            if (expected.insert(id).second) ids.add(id);
        } else if (!expected.empty()) {
            const int taken = ids.take(id);
            ASSERT_EQ(expected.count(taken), 1U);
            // Nearest in its word of 64, if that has one.
            const auto from = expected.lower_bound(id / 64 * 64);
            const auto to = expected.lower_bound(id / 64 * 64 + 64);
            for (auto it = from; it != to; ++it) ASSERT_LE(std::abs(taken - id), std::abs(*it - id));
            expected.erase(taken);
        }
        ASSERT_EQ(ids.count(), static_cast<int>(expected.size()));
    }
}

}  // namespace
}  // namespace neuralmesh
