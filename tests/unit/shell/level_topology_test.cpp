// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The lattice under the start mesh, against the obvious slow way of computing the same.
#include "vcg_core/shell/level_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "vcg_core/base/random.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/shell/marching_tetrahedra.h"

namespace neuralmesh {
namespace {

constexpr int kReach = 5;

Lattice small_lattice() {
    return Lattice(vcg::Box3f(vcg::Point3f(0, 0, 0), vcg::Point3f(9, 11, 8)), 1.0F, 1);
}

std::vector<std::uint32_t> random_counts(const Lattice& lattice, std::uint64_t seed, std::uint32_t one_in) {
    Random random(seed);
    std::vector<std::uint32_t> counts(lattice.size(), 0);
    for (std::uint32_t& c : counts)
        if (random.below(one_in) == 0) c = 1 + random.below(3);
    return counts;
}

template <class Visit>
void for_each_node(const Lattice& l, const Visit& visit) {
    for (int z = 0; z < l.nz; ++z)
        for (int y = 0; y < l.ny; ++y)
            for (int x = 0; x < l.nx; ++x) visit(x, y, z);
}

TEST(ShellField, DistancesAreThoseOfBruteForce) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Lattice lattice = small_lattice();
        const auto counts = random_counts(lattice, seed, 200);
        const auto distances = squared_distances(lattice, counts, kReach);
        for_each_node(lattice, [&](int x, int y, int z) {
            int best = kReach * kReach + 1;
            for_each_node(lattice, [&](int a, int b, int c) {
                if (counts[lattice.index(a, b, c)] != 0)
                    best = std::min(best, (a - x) * (a - x) + (b - y) * (b - y) + (c - z) * (c - z));
            });
            ASSERT_EQ(distances[lattice.index(x, y, z)], best) << x << ' ' << y << ' ' << z;
        });
    }
}

TEST(ShellField, ClearancesAreTheFixedPointOfRelaxation) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Lattice lattice = small_lattice();
        const auto distances = squared_distances(lattice, random_counts(lattice, seed, 12), kReach);
        std::vector<SquaredRadius> expected(lattice.size(), 0);
        for (bool changed = true; changed;) {
            changed = false;
            for_each_node(lattice, [&](int x, int y, int z) {
                const bool wall = x == 0 || y == 0 || z == 0 || x == lattice.nx - 1 || y == lattice.ny - 1 ||
                                  z == lattice.nz - 1;
                const std::size_t i = lattice.index(x, y, z);
                SquaredRadius best = wall ? distances[i] : SquaredRadius{0};
                for_each_neighbour(lattice, i, [&](std::size_t j) {
                    best = std::max(best, std::min(expected[j], distances[i]));
                });
                if (best > expected[i]) {
                    expected[i] = best;
                    changed = true;
                }
            });
        }
        EXPECT_EQ(clearances(lattice, distances, kReach, {}), expected);
    }
}

/// What is counted on the lattice is what gets meshed, at every level: the start mesh rests on that.
TEST(ShellField, TopologyOfLevelsIsThatOfTheMesh) {
    int handles = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        const Lattice lattice = small_lattice();
        const auto counts = random_counts(lattice, seed, 20);
        const auto distances = squared_distances(lattice, counts, kReach);
        const auto clearance = clearances(lattice, distances, kReach, {});
        const auto topologies = topology_of_levels(lattice, clearance, counts, kReach, 0);
        ASSERT_EQ(topologies.size(), static_cast<std::size_t>(kReach * kReach + 1));
        for (int level = 0; level < 4; ++level) {
            Lattice padded = lattice;  // the mesh needs empty walls
            padded.nx += 2;
            padded.ny += 2;
            padded.nz += 2;
            std::vector<float> values(padded.size(), 1.0F);
            for_each_node(lattice, [&](int x, int y, int z) {
                if (clearance[lattice.index(x, y, z)] <= level)
                    values[padded.index(x + 1, y + 1, z + 1)] = -1.0F;
            });
            const IndexedMesh mesh = marching_tetrahedra(padded, values);
            const Network network(mesh.positions, mesh.faces);
            ASSERT_EQ(network.validate(), "");
            EXPECT_EQ(network.boundary_loop_count(), 0);
            EXPECT_EQ(network.component_count(), topologies[static_cast<std::size_t>(level)].components);
            EXPECT_EQ(network.genus(), topologies[static_cast<std::size_t>(level)].genus);
            handles += network.genus();
        }
    }
    EXPECT_GT(handles, 0);  // else the test would prove little
}

TEST(ShellField, SmallComponentsCountAsSpecks) {
    const Lattice lattice = small_lattice();
    std::vector<std::uint32_t> counts(lattice.size(), 0);
    counts[lattice.index(2, 2, 2)] = 10;
    counts[lattice.index(8, 8, 8)] = 3;
    const auto distances = squared_distances(lattice, counts, kReach);
    const auto topologies =
        topology_of_levels(lattice, clearances(lattice, distances, kReach, {}), counts, kReach, 5);
    EXPECT_EQ(topologies[1].components, 1);
    EXPECT_EQ(topologies[1].specks, 1);
    EXPECT_EQ(topologies[1].speck_points, 3);
    EXPECT_EQ(topologies[1].genus, 0);
}

/// A box of points with a hole in its lid: a ball of radius 1 gets in, but the room behind is much wider.
TEST(ShellField, SpaceBehindANarrowOpeningIsSealed) {
    const Lattice lattice(vcg::Box3f(vcg::Point3f(0, 0, 0), vcg::Point3f(16, 16, 16)), 1.0F, 2);
    std::vector<std::uint32_t> counts(lattice.size(), 0);
    for_each_node(lattice, [&](int x, int y, int z) {
        const int low = std::min({x, y, z}), high = std::max({x, y, z});
        const bool hole = z == 18 && std::abs(x - 10) <= 1 && std::abs(y - 10) <= 1;
        if (low >= 2 && high <= 18 && (low == 2 || high == 18) && !hole) counts[lattice.index(x, y, z)] = 1;
    });
    constexpr int kFar = 12;
    const auto distances = squared_distances(lattice, counts, kFar);
    const auto open = clearances(lattice, distances, kFar, {});
    const std::size_t middle = lattice.index(10, 10, 10);
    EXPECT_GT(open[middle], 1);  // a ball of radius 1 reaches the middle
    const SealedSpaces sealing = enclosed_spaces(lattice, distances, open, 1.7, 0);
    EXPECT_EQ(sealing.inside[middle], 1);
    EXPECT_EQ(sealing.widest_opening, open[middle]);
    const auto sealed = clearances(lattice, distances, kFar, sealing.inside);
    EXPECT_EQ(sealed[middle], 0);
    EXPECT_GT(sealed[lattice.index(0, 0, 0)], 0);  // outside stays outside
    EXPECT_EQ(topology_of_levels(lattice, sealed, counts, kFar, 0)[1].genus, 0);
}

}  // namespace
}  // namespace neuralmesh
