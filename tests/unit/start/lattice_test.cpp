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

TEST(Lattice, CoversItsBoxAndTheMargin) {
    const vcg::Box3f box(vcg::Point3f(-1, 2, 5), vcg::Point3f(1.9F, 2.5F, 5));
    const Lattice lattice(box, 0.5F, 2);
    EXPECT_EQ(lattice.nx, 6 + 1 + 4);
    EXPECT_EQ(lattice.ny, 1 + 1 + 4);
    EXPECT_EQ(lattice.nz, 0 + 1 + 4);
    const vcg::Point3f low = lattice.position(2, 2, 2);
    const vcg::Point3f high = lattice.position(lattice.nx - 3, lattice.ny - 3, lattice.nz - 3);
    for (int k = 0; k < 3; ++k) {
        EXPECT_LE(low[k], box.min[k]);
        EXPECT_GE(high[k], box.max[k]);
        EXPECT_NEAR(low[k] + high[k], box.min[k] + box.max[k], 1e-5F);
    }
}

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
        neighbours.for_each(i, [&](NodeId j, int k) {
            found.insert(j);
            const auto b = lattice.coordinates(j);
            const auto& offset = kNeighbourOffsets[static_cast<std::size_t>(k)];
            EXPECT_EQ(offset, (std::array<int, 3>{b[0] - a[0], b[1] - a[1], b[2] - a[2]}));
        });
        ASSERT_EQ(found, expected) << i;
    }
}

/// Labels by repeated minima: every member takes the smallest label among its neighbours.
PerNode<NodeId> labels_of(const Lattice& lattice, const PerNode<std::uint32_t>& members) {
    const Neighbours neighbours(lattice);
    PerNode<NodeId> labels(lattice.size());
    for (NodeId i = 0; i < lattice.size(); ++i) labels[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (NodeId i = 0; i < lattice.size(); ++i)
            neighbours.for_each(i, [&](NodeId j, int) {
                if (members[i] == 0 || members[j] == 0 || labels[j] >= labels[i]) return;
                labels[i] = labels[j];
                changed = true;
            });
    }
    return labels;
}

TEST(Lattice, ComponentsAreThoseOfRepeatedMinima) {
    const Lattice lattice = small_lattice();
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const PerNode<std::uint32_t> members = random_counts(lattice, seed, 8);
        const PerNode<NodeId> labels = labels_of(lattice, members);
        PerNode<NodeId> found(lattice.size(), -1);
        NodeId last = -1;
        int components = 0;
        const auto member = [&](NodeId i) { return members[i] != 0; };
        for_each_component(lattice, member, [&](const std::vector<NodeId>& nodes) {
            ++components;
            EXPECT_EQ(nodes.front(), *std::min_element(nodes.begin(), nodes.end()));
            EXPECT_GT(nodes.front(), last);
            last = nodes.front();
            for (const NodeId i : nodes) {
                EXPECT_EQ(found[i], -1);
                found[i] = nodes.front();
            }
        });
        for (NodeId i = 0; i < lattice.size(); ++i)
            ASSERT_EQ(found[i], members[i] != 0 ? labels[i] : -1) << i;
        EXPECT_GT(components, 10);
    }
}

}  // namespace
}  // namespace neuralmesh
