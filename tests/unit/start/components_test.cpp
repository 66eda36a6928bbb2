// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Components by runs against the union of all adjacent nodes.
#include "vcg_core/start/components.h"

#include <gtest/gtest.h>

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
        for (const std::uint8_t value : {0, 1}) {
            DisjointSets sets(lattice.size());
            for (NodeId i = 0; i < lattice.size(); ++i)
                neighbours.for_each(i, [&](NodeId j, int) {
                    if (nodes[i] == value && nodes[j] == value) sets.join(i, j);
                });
            PerNode<NodeId> found(lattice.size(), -1);
            NodeId last = -1;
            for_each_component(lattice, nodes, value, [&](Span<const Run> runs) {
                EXPECT_GT(runs[0].begin, last);
                last = runs[0].begin;
                for (const Run& run : runs) std::fill(run.begin_in(found), run.end_in(found), last);
            });
            for (NodeId i = 0; i < lattice.size(); ++i)
                ASSERT_EQ(found[i], nodes[i] == value ? sets.find(i) : -1) << i;
        }
    }
}

}  // namespace
}  // namespace neuralmesh
