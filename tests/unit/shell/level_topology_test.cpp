// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/level_topology.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "tests/unit/support/small_lattice.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/shell/marching_tetrahedra.h"

namespace neuralmesh {
namespace {

constexpr int kFarthestNode = 5;

/// The mesh of {clearance <= level}, with a layer of nodes outside added on all sides.
Network mesh_of_level(const Lattice& lattice, const PerNode<SquaredRadius>& clearance, int level) {
    Lattice padded = lattice;
    padded.nx += 2;
    padded.ny += 2;
    padded.nz += 2;
    PerNode<float> values(padded.size(), 1.0F);
    for_each_node(lattice, [&](int x, int y, int z) {
        if (clearance[lattice.index(x, y, z)] <= level) values[padded.index(x + 1, y + 1, z + 1)] = -1.0F;
    });
    const IndexedMesh<float> mesh = marching_tetrahedra(padded, values);
    return Network(mesh.positions, mesh.faces);
}

/// The choice of the start mesh relies on this: at every level the counted topology is that of the mesh.
TEST(LevelTopology, IsThatOfTheMesh) {
    int handles = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        const Lattice lattice = small_lattice();
        const PerNode<std::uint32_t> counts = random_counts(lattice, seed, 20);
        const PerNode<SquaredRadius> distances = squared_distances(lattice, counts, kFarthestNode);
        const PerNode<SquaredRadius> clearance = clearances(lattice, distances, kFarthestNode, {});
        const PerLevel<LevelTopology> topologies =
            topology_of_levels(lattice, clearance, counts, kFarthestNode, 0);
        ASSERT_EQ(topologies.size(), kFarthestNode * kFarthestNode + 1);
        for (int level = 0; level < 4; ++level) {
            const Network network = mesh_of_level(lattice, clearance, level);
            ASSERT_EQ(network.validate(), "");
            EXPECT_EQ(network.boundary_loop_count(), 0);
            EXPECT_EQ(network.component_count(), topologies[level].components);
            EXPECT_EQ(network.genus(), topologies[level].genus);
            handles += network.genus();
        }
    }
    EXPECT_GT(handles, 0);  // else the genus would not be tested
}

TEST(LevelTopology, HasTheEulerCharacteristicOfEachSolid) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        const Lattice lattice = small_lattice();
        const PerNode<std::uint32_t> counts = random_counts(lattice, seed, 20);
        const PerNode<SquaredRadius> clearance =
            clearances(lattice, squared_distances(lattice, counts, kFarthestNode), kFarthestNode, {});
        const PerLevel<LevelTopology> topologies =
            topology_of_levels(lattice, clearance, counts, kFarthestNode, 2);
        for (int level = 0; level < topologies.size(); ++level) {
            NodeSet solid(lattice.size());
            for (NodeId i = 0; i < solid.size(); ++i) solid[i] = clearance[i] <= level ? 1 : 0;
            EXPECT_EQ(topologies[level].surfaces() + topologies[level].specks - topologies[level].genus,
                      euler_characteristic(lattice, solid));
        }
    }
}

TEST(LevelTopology, SmallComponentsCountAsSpecks) {
    const Lattice lattice = small_lattice();
    PerNode<std::uint32_t> counts(lattice.size(), 0);
    counts[lattice.index(2, 2, 2)] = 10;
    counts[lattice.index(8, 8, 8)] = 3;
    const PerNode<SquaredRadius> distances = squared_distances(lattice, counts, kFarthestNode);
    const PerLevel<LevelTopology> topologies = topology_of_levels(
        lattice, clearances(lattice, distances, kFarthestNode, {}), counts, kFarthestNode, 5);
    EXPECT_EQ(topologies[1].components, 1);
    EXPECT_EQ(topologies[1].specks, 1);
    EXPECT_EQ(topologies[1].speck_points, 3);
    EXPECT_EQ(topologies[1].genus, 0);
    // They are 6 * sqrt(3) apart: balls of radius 5 have adjacent nodes.
    EXPECT_EQ(topologies.back().components, 1);
    EXPECT_EQ(topologies.back().specks, 0);
    EXPECT_EQ(topologies.back().speck_points, 0);
}

TEST(LevelTopology, EulerCharacteristicOfKnownSolids) {
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

/// The simplices all of whose nodes are in \p solid, one by one: those of odd dimension count -1.
int sum_over_simplices(const Lattice& lattice, const NodeSet& solid) {
    int sum = 0;
    for_each_node(lattice, [&](int x, int y, int z) {
        const auto in = [&](int corner) {
            const int cx = x + (corner & 1), cy = y + ((corner >> 1) & 1), cz = z + (corner >> 2);
            return lattice.contains(cx, cy, cz) && solid[lattice.index(cx, cy, cz)] != 0;
        };
        const std::function<void(int, int)> add = [&](int last, int sign) {
            sum += sign;
            for (int next = last + 1; next < 8; ++next)
                if ((last & next) == last && in(next)) add(next, -sign);
        };
        if (in(0)) add(0, 1);
    });
    return sum;
}

TEST(LevelTopology, EulerCharacteristicIsTheSumOverTheSimplices) {
    std::mt19937 random(1);
    for (const int nx : {1, 5, 62, 63, 64, 65, 127, 128, 129})
        for (const unsigned in_eight : {1U, 4U, 7U, 8U}) {
            Lattice lattice = small_lattice();
            lattice.nx = nx;
            NodeSet solid(lattice.size());
            for (NodeId i = 0; i < solid.size(); ++i) solid[i] = random() % 8 < in_eight ? 1 : 0;
            EXPECT_EQ(euler_characteristic(lattice, solid), sum_over_simplices(lattice, solid))
                << nx << " nodes along x, " << in_eight << " of 8 in the solid";
        }
}

}  // namespace
}  // namespace neuralmesh
