// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of sets of neighbours against a search for components and a count of simplices.
#include "vcg_core/start/node_link.h"
#include "vcg_core/start/components.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "tests/unit/support/small_lattice.h"

namespace neuralmesh {
namespace {

TEST(NodeLink, ConnectedSetsAreThoseOfOneComponent) {
    const Lattice lattice = small_lattice();
    const NodeId middle = lattice.index(5, 6, 7);
    const Neighbours neighbours(lattice);
    int differ = 0;
    for (NeighbourSet set = 0; set < NeighbourSet{1} << kNeighbourCount; ++set) {
        NodeSet members(lattice.size(), 0);
        neighbours.for_each(middle, [&](NodeId j, int k) { members[j] = set >> k & 1U; });
        int components = 0;
        for_each_component(lattice, members, 1, [&](Span<const Run>) { ++components; });
        differ += is_connected(set) != (components == 1) ? 1 : 0;
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
