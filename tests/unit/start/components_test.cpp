// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Components by runs against the union of all adjacent nodes.
#include "vcg_core/start/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/support/small_lattice.h"
#include "vcg_core/base/disjoint_sets.h"

namespace neuralmesh {
namespace {

TEST(Components, AreTheSetsThatAdjacentNodesJoin) {
    const Lattice lattice = small_lattice();
    const Neighbours neighbours(lattice);
    for (const std::uint32_t one_in : {2U, 3U, 6U}) {
        NodeSet nodes;
        for (const std::uint32_t count : random_counts(lattice, one_in, one_in))
            nodes.push_back(count > 0 ? 1 : 0);
        for (const bool value : {false, true}) {
            DisjointSets sets(lattice.size());
            for (NodeId i = 0; i < lattice.size(); ++i)
                neighbours.for_each_at(i, neighbours.places(i), [&](NodeId j, int) {
                    if (nodes[i] == value && nodes[j] == value) sets.join(i, j);
                });
            PerNode<NodeId> found(lattice.size(), -1);
            NodeId last = -1;
            for_each_component(lattice, nodes, value, [&](const auto& runs) {
                EXPECT_GT(runs[0].begin, last);
                last = runs[0].begin;
                for (const auto& run : runs) std::fill(run.begin_in(found), run.end_in(found), last);
            });
            for (NodeId i = 0; i < lattice.size(); ++i)
                ASSERT_EQ(found[i], nodes[i] == value ? sets.find(i) : -1) << i;
        }
    }
}

TEST(Components, EulerCharacteristicOfKnownSolids) {
    const Lattice lattice = small_lattice();
    const auto euler = [&](const auto& inside) {
        NodeSet solid(lattice.size(), 0);
        for_each_node(lattice,
                      [&](int x, int y, int z) { solid[lattice.index(x, y, z)] = inside(x, y, z) ? 1 : 0; });
        return euler_characteristic(lattice, solid);
    };
    const auto in_cube = [](int x, int y, int z) {
        return x >= 2 && x <= 8 && y >= 2 && y <= 8 && z >= 2 && z <= 8;
    };
    EXPECT_EQ(euler([](int, int, int) { return false; }), 0);
    EXPECT_EQ(euler([](int x, int y, int z) { return x == 5 && y == 5 && z == 5; }), 1);
    EXPECT_EQ(euler(in_cube), 1);
    EXPECT_EQ(euler([&](int x, int y, int z) { return in_cube(x, y, z) && z != 5; }), 2);
    EXPECT_EQ(euler([&](int x, int y, int z) { return in_cube(x, y, z) && (x != 5 || y != 5); }), 0);
    EXPECT_EQ(euler([&](int x, int y, int z) { return in_cube(x, y, z) && (x != 5 || y != 5 || z != 5); }),
              2);  // a cavity
}

}  // namespace
}  // namespace neuralmesh
