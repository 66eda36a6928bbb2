// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The partitions of rims against their known numbers, and Euler characteristics against those of meshes.
#include "vcg_core/topology/rim_parts.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

TEST(RimParts, AreAllPartitionsOnceEach) {
    const std::vector<std::size_t> bell{1, 1, 2, 5, 15, 52};
    for (std::size_t rims = 0; rims < bell.size(); ++rims) {
        const std::vector<RimParts> all = partitions(rims);
        EXPECT_EQ(all.size(), bell[rims]);
        EXPECT_EQ(std::set<RimParts>(all.begin(), all.end()).size(), all.size());
        for (const RimParts& parts : all) {
            std::set<std::size_t> seen;
            for (const auto& part : parts) {
                EXPECT_FALSE(part.empty());
                for (const std::size_t rim : part) EXPECT_TRUE(seen.insert(rim).second);
            }
            EXPECT_EQ(seen.size(), rims);
        }
    }
}

TEST(RimParts, ConnectMembranesThatShareAPart) {
    EXPECT_TRUE(connect_all({{0}, {1}}, {0, 0}));
    EXPECT_FALSE(connect_all({{0}, {1}}, {0, 1}));
    EXPECT_TRUE(connect_all({{0, 1}}, {0, 1}));
    EXPECT_TRUE(connect_all({{0, 2}, {1, 3}}, {0, 0, 1, 2}));
    EXPECT_FALSE(connect_all({{0, 1}, {2, 3}}, {0, 0, 1, 1}));
}

TEST(RimParts, HaveTheEulerCharacteristicOfTheirPatches) {
    EXPECT_EQ(euler_characteristic({{0}, {1, 2}, {3, 4, 5}}), 1 + 0 - 1);
    const Network disc = referee::network_of(shapes::fan(5));
    EXPECT_EQ(euler_characteristic(disc.faces(), {Rim(7)}), 1);
    const Network ball = referee::network_of(shapes::icosphere(1));
    EXPECT_EQ(euler_characteristic(ball.faces(), {}), 2);
}

}  // namespace
}  // namespace neuralmesh
