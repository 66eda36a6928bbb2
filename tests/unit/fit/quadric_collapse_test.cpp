// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge collapses by quadric errors: counts, topology, what stays where it is.
#include "vcg_core/fit/quadric_collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/fit/fit_scene.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {
namespace {

PerVertex<char> none(const Network& network) { return PerVertex<char>(network.slot_count(), 0); }

TEST(QuadricCollapse, KeepsTheTopologyAndComesToTheNumber) {
    for (const int vertices : {2000, 500, 100}) {
        Network network = referee::network_of(shapes::torus_grid(60, 40));
        const int before = network.vertex_count();
        const auto done = collapse_by_quadrics(network, vertices, none(network));
        EXPECT_EQ(network.validate(), "");
        EXPECT_EQ(network.vertex_count(), vertices);
        EXPECT_EQ(static_cast<int>(done.size()), before - vertices);
        EXPECT_EQ(network.genus(), 1);
        ThreadTeam team(1);
        EXPECT_TRUE(self_crossings(Surface(network), team).empty()) << vertices;
        for (const VertexId v : network.vertices()) EXPECT_LE(network.ring(v).valence, 10);
    }
}

TEST(QuadricCollapse, StopsWhereNoMoreCanGo) {
    Network network = referee::network_of(shapes::icosphere(2));
    const auto done = collapse_by_quadrics(network, 0, none(network));
    EXPECT_FALSE(done.empty());
    EXPECT_EQ(network.validate(), "");
    EXPECT_GE(network.vertex_count(), 4);
    EXPECT_EQ(network.genus(), 0);
}

TEST(QuadricCollapse, ReportsTheCollapsesInOrder) {
    Network network = referee::network_of(shapes::icosphere(3), 0.02);
    const Network before = network;
    const auto done = collapse_by_quadrics(network, 200, none(network));
    PerVertex<char> gone = none(network);
    for (const VertexMoves::DoneCollapse& collapse : done) {
        EXPECT_EQ(gone[collapse.gone], 0);
        EXPECT_EQ(gone[collapse.into], 0);
        gone[collapse.gone] = 1;
    }
    for (const VertexId v : before.vertices()) EXPECT_EQ(network.alive(v), gone[v] == 0);
}

TEST(QuadricCollapse, LeavesBarredAndBoundaryVerticesAlone) {
    const Network before = referee::network_of(shapes::grid(20, 20), 0.01);
    PerVertex<char> barred = none(before);
    for (VertexId v = 0; v < barred.size(); v += 7) barred[v] = 1;
    Network network = before;
    EXPECT_FALSE(collapse_by_quadrics(network, 250, barred).empty());
    EXPECT_EQ(network.validate(), "");
    for (const VertexId v : before.vertices()) {
        if (barred[v] == 0 && before.ring(v).open == 0) continue;
        ASSERT_TRUE(network.alive(v));
        EXPECT_EQ(network.position(v), before.position(v));
        EXPECT_EQ(network.ring(v).open, before.ring(v).open);
    }
}

// The plain reference: of two ways to remove a vertex, the one that keeps the shape costs less.
TEST(QuadricCollapse, RemovesFromFlatPartsFirst) {
    shapes::Shape shape = shapes::icosphere(4);
    const auto largest = [](const vcg::Point3d& p) {
        return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    };
    for (vcg::Point3d& p : shape.positions) p /= 2 * largest(p);
    Network network = referee::network_of(shape);
    const Network before = network;
    collapse_by_quadrics(network, before.vertex_count() / 3, none(network));
    const auto points = FitScene(before, shapes::box_cloud(5000)).tracked.points;
    const auto squares = [&](const Network& n) {
        const Surface surface(n);
        ThreadTeam team(1);
        double sum = 0;
        for (const Hit& hit : nearest_by_tree(surface, {points, {}, {}}, team))
            sum += static_cast<double>(hit.foot.squared_distance);
        return sum;
    };
    EXPECT_LT(squares(network), 1.1 * squares(before));
}

}  // namespace
}  // namespace neuralmesh
