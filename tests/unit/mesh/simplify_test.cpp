// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/support/network_starts.h"
#include "tests/unit/support/referee.h"

namespace neuralmesh {
namespace {

using network_starts::together;
using referee::Census;
using referee::census;
using referee::network_of;

/// Simplifies \p shape to each of the numbers of vertices and checks what simplify() promises.
void expect_simplified(const shapes::Shape& shape, const std::vector<int>& counts) {
    const Network before = network_of(shape);
    const Census topology = census(before.faces());
    const double volume = referee::enclosed_volume(before);
    for (const int vertices : counts) {
        SCOPED_TRACE(testing::Message() << before.vertex_count() << " to " << vertices);
        Network network = before;
        simplify(network, vertices);
        ASSERT_EQ(network.validate(), "");
        const Census now = census(network.faces());
        EXPECT_EQ(now.breach, "");
        EXPECT_TRUE(now.same_topology(topology));
        EXPECT_EQ(network.vertex_count(), std::min(vertices, before.vertex_count()));
        EXPECT_LE(now.greatest_valence(), 12);
        if (vertices < 100) continue;
        EXPECT_NEAR(referee::enclosed_volume(network), volume, 0.2 * volume);
    }
}

TEST(Simplify, GivesTheExactNumberOfVertices) {
    expect_simplified(shapes::icosphere(4), {12, 50, 100, 500, 2000, 2562, 5000});
}

TEST(Simplify, KeepsHandles) { expect_simplified(shapes::torus_grid(60, 30), {40, 100, 500, 1799}); }

TEST(Simplify, KeepsComponents) {
    expect_simplified(together(shapes::torus_grid(40, 20), shapes::icosphere(3), {4, 0, 0}), {80, 300, 1000});
}

TEST(Simplify, StopsWhereTheTopologyNeedsMoreVertices) {
    Network network = network_of(shapes::torus_grid(40, 20));
    simplify(network, 4);
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.genus(), 1);
    EXPECT_GE(network.vertex_count(), 7) << "the smallest triangulation of a torus";
    EXPECT_LE(network.vertex_count(), 30);
}

/// Checks the lengths of the edges, and that a share of \p regular of the valences is 5, 6 or 7.
void expect_even(const Network& network, double regular) {
    double shortest = 1e30;
    double sum = 0;
    int ends = 0;
    int count = 0;
    for (const VertexId v : network.vertices()) {
        count += network.ring(v).valence >= 5 && network.ring(v).valence <= 7 ? 1 : 0;
        for (const VertexId w : network.ring(v)) {
            const auto length = static_cast<double>((network.position(v) - network.position(w)).Norm());
            shortest = std::min(shortest, length);
            sum += length;
            ++ends;
        }
    }
    EXPECT_GT(shortest, 0.3 * sum / ends);
    EXPECT_GE(count, regular * network.vertex_count());
}

TEST(Simplify, MakesEvenTrianglesOfLongOnes) {
    Network network = network_of(shapes::torus_grid(200, 12));
    simplify(network, 400);
    expect_even(network, 0.99);
}

TEST(Simplify, MakesEvenTrianglesOfRoughOnes) {
    shapes::Shape rough = shapes::icosphere(4);
    Random random(1);
    for (vcg::Point3d& p : rough.positions) p *= 1 + 0.1 * static_cast<double>(random.unit());
    Network network = network_of(rough);
    simplify(network, 500);
    expect_even(network, 0.98);
}

TEST(Simplify, MakesEdgesInProportionToTheLengthsAskedFor) {
    Network network = network_of(shapes::icosphere(5));
    PerVertex<float> lengths(network.slot_count(), 0.1F);
    for (const VertexId v : network.vertices())
        if (network.position(v)[0] > 0) lengths[v] = 0.3F;
    simplify(network, 1000, lengths);
    ASSERT_EQ(network.validate(), "");
    EXPECT_EQ(network.vertex_count(), 1000);
    int coarse = 0;
    for (const VertexId v : network.vertices()) coarse += network.position(v)[0] > 0 ? 1 : 0;
    // A ninth of the vertices of the other half, and those near the border.
    EXPECT_GT(coarse, 80);
    EXPECT_LT(coarse, 200);
}

}  // namespace
}  // namespace neuralmesh
