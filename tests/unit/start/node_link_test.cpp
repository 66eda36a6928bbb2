// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of sets of neighbours against a search for components and a count of simplices.
#include "vcg_core/start/node_link.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "tests/unit/support/small_lattice.h"

namespace neuralmesh {
namespace {

template <class Member>
NeighbourSet set_of(const Neighbours& neighbours, NodeId i, const Member& member) {
    return neighbours_in(neighbours, i, neighbours.places(i), member);
}

TEST(NodeLink, ConnectedSetsAreThoseOfOneComponent) {
    const Lattice lattice = small_lattice();
    const NodeId middle = lattice.index(5, 6, 7);
    const Neighbours neighbours(lattice);
    int differ = 0;
    for (NeighbourSet set = 0; set < NeighbourSet{1} << kNeighbourCount; ++set) {
        NodeSet members(lattice.size(), 0);
        neighbours.for_each(middle, [&](NodeId j, int k) { members[j] = set >> k & 1U; });
        // Only the neighbours are searched: a search of the whole lattice would take a minute.
        int components = 0;
        std::vector<NodeId> nodes;
        neighbours.for_each(middle, [&](NodeId j, int) {
            if (members[j] == 0) return;
            ++components;
            members[j] = 0;
            flood(
                neighbours, j,
                [&](NodeId i) {
                    if (members[i] == 0) return false;
                    members[i] = 0;
                    return true;
                },
                nodes);
        });
        differ += LinkTopology::table().is_connected(set) != (components == 1) ? 1 : 0;
    }
    EXPECT_EQ(differ, 0);
}

TEST(NodeLink, EulerCharacteristicsAreThoseOfTheSimplices) {
    const Lattice lattice = small_lattice();
    const Neighbours neighbours(lattice);
    const NodeId middle = lattice.index(5, 6, 7);
    const auto adjacent = [&](int a, int b) {
        const NodeId there = neighbours.at(middle, b);
        return set_of(neighbours, neighbours.at(middle, a), [&](NodeId j) { return j == there; }) != 0;
    };
    int differ = 0;
    for (NeighbourSet set = 0; set < NeighbourSet{1} << kNeighbourCount; set += 7) {
        int euler = 0;
        for (int a = 0; a < kNeighbourCount; ++a) {
            if ((set >> a & 1U) == 0) continue;
            ++euler;
            for (int b = 0; b < a; ++b) {
                if ((set >> b & 1U) == 0 || !adjacent(a, b)) continue;
                --euler;
                for (int c = 0; c < b; ++c)
                    if ((set >> c & 1U) != 0 && adjacent(a, c) && adjacent(b, c)) ++euler;
            }
        }
        differ += LinkTopology::table().euler_characteristic(set) != euler ? 1 : 0;
    }
    EXPECT_EQ(differ, 0);
}

TEST(NodeLink, EulerCharacteristicOfKnownSolids) {
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
