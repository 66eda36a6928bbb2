// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of connected sets against a search for components, for all sets.
#include "vcg_core/shell/node_link.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/support/small_lattice.h"

namespace neuralmesh {
namespace {

TEST(NodeLink, NeighboursAreTakenInTheOrderOfTheOffsets) {
    const Lattice lattice = small_lattice();
    const NodeId middle = lattice.index(5, 6, 7);
    const Neighbours neighbours(lattice);
    for (int k = 0; k < kNeighbourCount; ++k) {
        const NodeOffset& offset = kNeighbourOffsets[static_cast<std::size_t>(k)];
        const NodeId there = lattice.index(5 + offset[0], 6 + offset[1], 7 + offset[2]);
        EXPECT_EQ(neighbours.at(middle, k), there);
        EXPECT_EQ(neighbours_in(neighbours, middle, [&](NodeId j) { return j == there; }), 1U << k);
    }
    const NeighbourSet of_corner = neighbours_in(neighbours, 0, [](NodeId) { return true; });
    EXPECT_EQ(of_corner, 0b01010101010101U) << "those with no coordinate below 0";
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
        differ += LinkConnected::table()(set) != (components == 1) ? 1 : 0;
    }
    EXPECT_EQ(differ, 0);
}

}  // namespace
}  // namespace neuralmesh
