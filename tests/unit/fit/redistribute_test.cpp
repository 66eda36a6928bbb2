// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moving and removing vertices: counts, topology, and operations that must not touch each other.
#include "vcg_core/fit/redistribute.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "tests/unit/fit/fit_scene.h"

namespace neuralmesh {
namespace {

/// Points of a cube, around a network whose faces cut its edges: vertices are missing there and superfluous
/// on the sides.
FitScene cube_scene() {
    shapes::Shape shape = shapes::icosphere(3);
    for (vcg::Point3d& p : shape.positions)
        p /= 2 * std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    return {referee::network_of(shape, 0.001), shapes::box_cloud(30000)};
}

TEST(Redistribute, KeepsTheVertexCountAndTheTopology) {
    const FitScene scene = cube_scene();
    ThreadTeam team(2);
    const std::vector<Collapse> collapses = find_collapses(scene.network, scene.surface, scene.points, team);
    const std::vector<EdgeSplit> splits =
        find_splits(scene.network, scene.surface, scene.points, 1e-3F, team);
    for (int max_pairs : {0, 1, 10, 1000}) {
        Network network = scene.network;
        const std::vector<DoneCollapse> done =
            redistribute(network, collapses, splits, max_pairs, PerVertex<char>(network.slot_count(), 0));
        EXPECT_EQ(network.validate(), "");
        EXPECT_EQ(network.vertex_count(), scene.network.vertex_count());
        EXPECT_EQ(network.genus(), 0);
        EXPECT_EQ(network.component_count(), 1);
        EXPECT_LE(static_cast<int>(done.size()), max_pairs);
        EXPECT_GE(static_cast<int>(done.size()), std::min(max_pairs, 10));
    }
}

TEST(Redistribute, StopsWhereASplitGainsLessThanTheCollapseCosts) {
    const FitScene scene = cube_scene();
    ThreadTeam team(1);
    std::vector<Collapse> collapses = find_collapses(scene.network, scene.surface, scene.points, team);
    const std::vector<EdgeSplit> splits =
        find_splits(scene.network, scene.surface, scene.points, 1e-3F, team);
    for (Collapse& collapse : collapses) collapse.cost = splits.front().gain;
    Network network = scene.network;
    const PerVertex<char> none(network.slot_count(), 0);
    EXPECT_TRUE(redistribute(network, collapses, splits, 10, none).empty());
    EXPECT_EQ(network.faces(), scene.network.faces());
}

TEST(Redistribute, LeavesBarredVerticesAlone) {
    const FitScene scene = cube_scene();
    ThreadTeam team(1);
    const std::vector<Collapse> collapses = find_collapses(scene.network, scene.surface, scene.points, team);
    const std::vector<EdgeSplit> splits =
        find_splits(scene.network, scene.surface, scene.points, 1e-3F, team);
    PerVertex<char> barred(scene.network.slot_count(), 0);
    for (VertexId v = 0; v < barred.size(); v += 7) barred[v] = 1;
    Network network = scene.network;
    EXPECT_FALSE(redistribute(network, collapses, splits, 1000, barred).empty());
    for (VertexId v = 0; v < barred.size(); v += 7) {
        ASSERT_TRUE(network.alive(v));
        EXPECT_EQ(network.ring(v).valence, scene.network.ring(v).valence);
    }
}

// Edges that end on the boundary are split in their middle; the boundary keeps its vertices.
TEST(Redistribute, LeavesTheBoundaryAlone) {
    const Network grid = referee::network_of(shapes::grid(8, 8));
    const auto boundary = [](const Network& network) {
        PerVertex<char> result(network.slot_count(), 0);
        for (VertexId v : network.vertices()) result[v] = static_cast<char>(network.ring(v).open);
        return result;
    };
    int splits = 0;
    for (VertexId a : grid.vertices())
        for (VertexId b : grid.ring(a)) {
            const Ring& ring = grid.ring(a);
            const int i = ring.find(b);
            if (ring.open != 0 && (i == 0 || i + 1 == ring.valence)) continue;
            const vcg::Point3f middle = (grid.position(a) + grid.position(b)) / 2;
            for (VertexId gone : {27, 35, 45}) {
                Network network = grid;
                const auto done =
                    redistribute(network, {{0, gone, grid.ring(gone)[0]}}, {{1, a, b, to_eigen(middle)}}, 1,
                                 PerVertex<char>(network.slot_count(), 0));
                if (done.empty()) continue;
                ASSERT_EQ(network.validate(), "");
                EXPECT_EQ(boundary(network), boundary(grid)) << a << ' ' << b;
                ++splits;
                EXPECT_TRUE(network.adjacent(gone, a));
                EXPECT_TRUE(network.adjacent(gone, b));
            }
        }
    EXPECT_GT(splits, 200);
}

TEST(Redistribute, SplitsBoundaryEdgesOnTheBoundary) {
    const Network grid = referee::network_of(shapes::grid(8, 8));
    int splits = 0;
    for (VertexId a : grid.vertices()) {
        if (grid.ring(a).open == 0 || grid.adjacent(a, 27)) continue;
        const VertexId b = grid.ring(a)[0];
        const vcg::Point3f middle = (grid.position(a) + grid.position(b)) / 2;
        Network network = grid;
        const auto done = redistribute(network, {{0, 27, grid.ring(27)[0]}}, {{1, a, b, to_eigen(middle)}}, 1,
                                       PerVertex<char>(network.slot_count(), 0));
        ASSERT_EQ(done.size(), 1U) << a;
        ASSERT_EQ(network.validate(), "");
        const Ring& ring = network.ring(27);
        EXPECT_EQ(ring.valence, 3);
        EXPECT_EQ(ring[0], b);
        EXPECT_EQ(ring[2], a);
        ++splits;
    }
    EXPECT_GT(splits, 20);
}

TEST(Reduce, RemovesTheCheapestThatDoNotTouch) {
    const FitScene scene = cube_scene();
    ThreadTeam team(1);
    const std::vector<Collapse> collapses = find_collapses(scene.network, scene.surface, scene.points, team);
    for (int max_count : {1, 20, 10000}) {
        Network network = scene.network;
        const std::vector<DoneCollapse> done =
            reduce(network, collapses, max_count, PerVertex<char>(network.slot_count(), 0));
        EXPECT_EQ(network.validate(), "");
        EXPECT_EQ(network.genus(), 0);
        EXPECT_LE(static_cast<int>(done.size()), max_count);
        EXPECT_EQ(network.vertex_count(), scene.network.vertex_count() - static_cast<int>(done.size()));
        EXPECT_EQ(done.front().gone, collapses.front().gone);
        PerVertex<char> touched(scene.network.slot_count(), 0);
        for (const DoneCollapse& collapse : done) {
            EXPECT_EQ(touched[collapse.gone], 0);
            touched[collapse.gone] = 1;
            for (VertexId u : scene.network.ring(collapse.gone)) {
                EXPECT_EQ(touched[u], 0);
                touched[u] = 1;
            }
        }
    }
}

/// The corners of the faces around \p v and of those beyond its ring, as costs are measured on them.
std::set<std::array<VertexId, 3>> measured_faces(const Network& network, VertexId v) {
    std::set<std::array<VertexId, 3>> faces;
    const auto add = [&](VertexId a, VertexId b, VertexId c) {
        std::array<VertexId, 3> corners{a, b, c};
        std::sort(corners.begin(), corners.end());
        faces.insert(corners);
    };
    const Ring& ring = network.ring(v);
    for (int i = 0; i < ring.valence; ++i) {
        const Ring& around = network.ring(ring[i]);
        add(v, ring[i], ring.next(i));
        add(ring[i], ring.next(i), around.previous(around.find(ring.next(i))));
    }
    return faces;
}

TEST(ReduceDensely, RemovesOnlyWhatIsAsMeasured) {
    const FitScene scene = cube_scene();
    ThreadTeam team(1);
    const std::vector<Collapse> collapses = find_collapses(scene.network, scene.surface, scene.points, team);
    const PerVertex<char> none(scene.network.slot_count(), 0);
    for (int max_count : {1, 20, 10000}) {
        Network network = scene.network;
        const auto done = reduce_densely(network, collapses, max_count, none);
        EXPECT_EQ(network.validate(), "");
        EXPECT_EQ(network.genus(), 0);
        EXPECT_LE(static_cast<int>(done.size()), max_count);
        EXPECT_EQ(network.vertex_count(), scene.network.vertex_count() - static_cast<int>(done.size()));
        EXPECT_EQ(done.front().gone, collapses.front().gone);
        Network again = scene.network;
        for (const DoneCollapse& collapse : done) {
            EXPECT_EQ(measured_faces(again, collapse.gone), measured_faces(scene.network, collapse.gone));
            ASSERT_TRUE(again.can_collapse(collapse.gone, collapse.into));
            again.collapse(collapse.gone, collapse.into);
        }
        EXPECT_EQ(again.faces(), network.faces());
    }
}

TEST(ReduceDensely, LeavesBarredVerticesAlone) {
    const FitScene scene = cube_scene();
    ThreadTeam team(1);
    const std::vector<Collapse> collapses = find_collapses(scene.network, scene.surface, scene.points, team);
    PerVertex<char> barred(scene.network.slot_count(), 0);
    for (VertexId v = 0; v < barred.size(); v += 7) barred[v] = 1;
    Network network = scene.network;
    EXPECT_FALSE(reduce_densely(network, collapses, 10000, barred).empty());
    EXPECT_EQ(network.validate(), "");
    for (VertexId v = 0; v < barred.size(); v += 7) {
        ASSERT_TRUE(network.alive(v));
        EXPECT_EQ(network.ring(v).valence, scene.network.ring(v).valence);
    }
}

}  // namespace
}  // namespace neuralmesh
