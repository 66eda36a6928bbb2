// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "tests/unit/support/small_lattice.h"

namespace neuralmesh {
namespace {

TEST(Lattice, NodeOfAPointIsTheNearestOne) {
    const Lattice lattice = small_lattice();
    Random random(4);
    int outside = 0;
    for (int i = 0; i < 1000; ++i) {
        const float x = 16 * random.unit() - 3, y = 16 * random.unit() - 3, z = 16 * random.unit() - 3;
        const vcg::Point3f p(x, y, z);
        NodeId nearest = 0;
        for (NodeId j = 0; j < lattice.size(); ++j)
            if ((lattice.position(j) - p).SquaredNorm() < (lattice.position(nearest) - p).SquaredNorm())
                nearest = j;
        const vcg::Point3f away = lattice.position(nearest) - p;
        const float farthest = std::max({std::abs(away[0]), std::abs(away[1]), std::abs(away[2])});
        EXPECT_EQ(lattice.node_of(p), farthest > 0.5F * lattice.step ? lattice.size() : nearest);
        outside += farthest > 0.5F * lattice.step ? 1 : 0;
    }
    EXPECT_GT(outside, 100);
    EXPECT_LT(outside, 900);
    EXPECT_EQ(lattice.node_of({1e30F, 0, 0}), lattice.size());
    EXPECT_EQ(lattice.node_of({0, -1e30F, 0}), lattice.size());
}

TEST(Lattice, AdjacencyIsThatOfTheFreudenthalSubdivision) {
    const Lattice lattice = small_lattice();
    const Neighbours neighbours(lattice);
    for (NodeId i = 0; i < lattice.size(); ++i) {
        std::multiset<NodeId> expected, found;
        const auto a = lattice.coordinates(i);
        for_each_node(lattice, [&](int x, int y, int z) {
            const std::array<int, 3> d = {x - a[0], y - a[1], z - a[2]};
            const auto [low, high] = std::minmax_element(d.begin(), d.end());
            const bool ahead = *low == 0 && *high == 1, behind = *low == -1 && *high == 0;
            const bool diagonal = *low == *high && std::abs(*low) == 1;
            if (ahead || behind || diagonal) expected.insert(lattice.index(x, y, z));
        });
        neighbours.for_each_at(i, neighbours.places(i), [&](NodeId j, int k) {
            found.insert(j);
            const auto b = lattice.coordinates(j);
            const auto& offset = kNeighbourOffsets[static_cast<std::size_t>(k)];
            EXPECT_EQ(offset, (std::array<int, 3>{b[0] - a[0], b[1] - a[1], b[2] - a[2]}));
        });
        ASSERT_EQ(found, expected) << i;
    }
}

}  // namespace
}  // namespace neuralmesh
