// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Distances and clearances against brute force.
#include "vcg_core/start/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/unit/support/small_lattice.h"
#include "vcg_core/start/components.h"

namespace neuralmesh {
namespace {

constexpr int kLargestRadius = 5;

TEST(Clearance, DistancesAreThoseOfBruteForce) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Lattice lattice = small_lattice();
        const PerNode<std::uint32_t> counts = random_counts(lattice, seed, 200);
        const PerNode<SquaredRadius> distances = squared_distances(lattice, counts, kLargestRadius);
        for_each_node(lattice, [&](int x, int y, int z) {
            int best = kLargestRadius * kLargestRadius + 1;
            for_each_node(lattice, [&](int a, int b, int c) {
                if (counts[lattice.index(a, b, c)] != 0)
                    best = std::min(best, (a - x) * (a - x) + (b - y) * (b - y) + (c - z) * (c - z));
            });
            ASSERT_EQ(distances[lattice.index(x, y, z)], best) << x << ' ' << y << ' ' << z;
        });
    }
}

/// The definition as a fixed point: starts from 0 and raises clearances until none can be raised.
PerNode<SquaredRadius> relaxed_clearances(const Lattice& lattice, const PerNode<SquaredRadius>& distances) {
    const Neighbours neighbours(lattice);
    PerNode<SquaredRadius> result(lattice.size(), 0);
    for (bool changed = true; changed;) {
        changed = false;
        for_each_node(lattice, [&](int x, int y, int z) {
            const bool wall = x == 0 || y == 0 || z == 0 || x == lattice.nx - 1 || y == lattice.ny - 1 ||
                              z == lattice.nz - 1;
            const NodeId i = lattice.index(x, y, z);
            SquaredRadius best = wall ? distances[i] : SquaredRadius{0};
            neighbours.for_each_at(i, neighbours.places(i), [&](NodeId j, int) {
                best = std::max(best, std::min(result[j], distances[i]));
            });
            changed = changed || best > result[i];
            result[i] = std::max(result[i], best);
        });
    }
    return result;
}

TEST(Clearance, IsTheFixedPointOfRelaxation) {
    for (const std::uint64_t seed : {1U, 2U, 3U})
        for (const std::uint32_t one_in : {3U, 12U, 200U}) {
            const Lattice lattice = small_lattice();
            const PerNode<SquaredRadius> distances =
                squared_distances(lattice, random_counts(lattice, seed, one_in), kLargestRadius);
            const PerNode<SquaredRadius> relaxed = relaxed_clearances(lattice, distances);
            EXPECT_EQ(clearances(lattice, distances, kLargestRadius, {}), relaxed) << one_in;
        }
}

/// The surface of a cube of 17 x 17 x 17 nodes with a hole of 3 x 3 nodes in its lid.
TEST(Clearance, SpaceBehindANarrowOpeningIsSealed) {
    const Lattice lattice(vcg::Box3f(vcg::Point3f(0, 0, 0), vcg::Point3f(16, 16, 16)), 1.0F, 2);
    PerNode<std::uint32_t> counts(lattice.size(), 0);
    for_each_node(lattice, [&](int x, int y, int z) {
        const int low = std::min({x, y, z}), high = std::max({x, y, z});
        const bool hole = z == 18 && std::abs(x - 10) <= 1 && std::abs(y - 10) <= 1;
        if (low >= 2 && high <= 18 && (low == 2 || high == 18) && !hole) counts[lattice.index(x, y, z)] = 1;
    });
    constexpr int kMax = 12;
    const PerNode<SquaredRadius> distances = squared_distances(lattice, counts, kMax);
    const PerNode<SquaredRadius> open = clearances(lattice, distances, kMax, {});
    const NodeId middle = lattice.index(10, 10, 10);
    EXPECT_GT(open[middle], 1);  // a ball of radius 1 reaches the middle
    const SealedSpaces sealed = enclosed_spaces(lattice, distances, open, 1.7, 0);
    EXPECT_EQ(sealed.inside[middle], 1);
    EXPECT_EQ(sealed.widest_opening, open[middle]);
    EXPECT_EQ(sealed.nodes, std::count(sealed.inside.begin(), sealed.inside.end(), 1));
    const PerNode<SquaredRadius> closed = clearances(lattice, distances, kMax, sealed.inside);
    EXPECT_EQ(closed[middle], 0);
    EXPECT_GT(closed[lattice.index(0, 0, 0)], 0);
    EXPECT_EQ(euler_characteristic(lattice, solid_of(lattice, closed, counts, 1, 1).nodes), 1);
    // The middle is 8 steps from the points: no space is that much wider than its opening, or that deep.
    EXPECT_EQ(enclosed_spaces(lattice, distances, open, 8, 0).nodes, 0);
    EXPECT_EQ(enclosed_spaces(lattice, distances, open, 1.7, 8 * 8 + 1).nodes, 0);
}

TEST(Clearance, SmallComponentsAreSpecks) {
    const Lattice lattice = small_lattice();
    PerNode<std::uint32_t> counts(lattice.size(), 0);
    counts[lattice.index(2, 2, 2)] = 10;
    counts[lattice.index(8, 8, 8)] = 3;
    const PerNode<SquaredRadius> distances = squared_distances(lattice, counts, kLargestRadius);
    const PerNode<SquaredRadius> clearance = clearances(lattice, distances, kLargestRadius, {});
    const Solid small = solid_of(lattice, clearance, counts, 1, 5);
    EXPECT_EQ(small.components, 1);
    EXPECT_EQ(small.points_in_specks, 3);
    EXPECT_EQ(small.nodes[lattice.index(2, 2, 3)], 1);
    EXPECT_EQ(small.nodes[lattice.index(8, 8, 8)], 0);
    // They are 6 * sqrt(3) apart: balls of radius 5 have adjacent nodes.
    const Solid large = solid_of(lattice, clearance, counts, kLargestRadius * kLargestRadius, 5);
    EXPECT_EQ(large.components, 1);
    EXPECT_EQ(large.points_in_specks, 0);
}

}  // namespace
}  // namespace neuralmesh
