// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moving, removing and adding vertices: counts, topology, and operations that must not touch each other.
#include "vcg_core/fit/redistribute.h"
#include "tests/unit/fit/fit_scene.h"
#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"
#include "vcg_core/fit/fitter.h"
#include "vcg_core/mesh/self_intersections.h"

namespace neuralmesh::redistribute_test {

/// Points of a cube, around a network whose faces cut its edges: vertices are missing there and superfluous
/// on the sides.
class OnACube : public testing::Test {
protected:
    OnACube() : scene(network_inside(), shapes::box_cloud(30000)) {
        collapses = find_collapses(scene.network, scene.surface, scene.points, team);
        splits = find_splits(scene.network, scene.surface, scene.points, 1e-3F, team);
        none.resize(network.slot_count(), 0);
        barred = none;
        for (VertexId v = 0; v < barred.size(); v += 7) barred[v] = 1;
    }

    static Network network_inside() {
        Shape shape = shapes::icosphere(3);
        for (vcg::Point3d& p : shape.positions)
            p /= 2 * std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
        return network_of(shape, 0.001);
    }

    void expect_sound(std::size_t removed) const {
        EXPECT_EQ(topology_of(network), kBall);
        EXPECT_EQ(network.vertex_count(), scene.network.vertex_count() - static_cast<int>(removed));
    }

    void expect_barred_untouched() const {
        for (VertexId v = 0; v < barred.size(); v += 7) {
            ASSERT_TRUE(network.alive(v));
            EXPECT_EQ(network.ring(v).valence, scene.network.ring(v).valence);
        }
    }

    const FitScene scene;
    Network network = scene.network;
    ThreadTeam team{2};
    std::vector<Collapse> collapses;
    std::vector<EdgeSplit> splits;
    PerVertex<char> none, barred;
};

TEST_F(OnACube, RedistributeKeepsTheVertexCountAndTheTopology) {
    for (const int max_pairs : {0, 1, 10, 1000}) {
        network = scene.network;
        const auto done = static_cast<int>(redistribute(network, collapses, splits, max_pairs, none).size());
        expect_sound(0);
        EXPECT_LE(done, max_pairs);
        EXPECT_GE(done, std::min(max_pairs, 10));
    }
}

TEST_F(OnACube, RedistributeStopsWhereASplitGainsLessThanTheCollapseCosts) {
    for (Collapse& collapse : collapses) collapse.cost = splits.front().gain;
    EXPECT_TRUE(redistribute(network, collapses, splits, 10, none).empty());
    EXPECT_EQ(network.faces(), scene.network.faces());
}

TEST_F(OnACube, BarredVerticesAreLeftAlone) {
    EXPECT_FALSE(redistribute(network, collapses, splits, 1000, barred).empty());
    expect_barred_untouched();
    network = scene.network;
    EXPECT_FALSE(reduce_densely(network, collapses, 10000, barred).empty());
    EXPECT_EQ(network.validate(), "");
    expect_barred_untouched();
}

// Edges that end on the boundary are split in their middle; the boundary keeps its vertices.
TEST(Redistribute, LeavesTheBoundaryAlone) {
    const Network grid = network_of(shapes::grid(8, 8));
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
    const Network grid = network_of(shapes::grid(8, 8));
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

TEST_F(OnACube, ReduceRemovesTheCheapestThatDoNotTouch) {
    for (const std::size_t max_count : {1, 20, 10000}) {
        network = scene.network;
        const auto done = reduce(network, collapses, static_cast<int>(max_count), none);
        expect_sound(done.size());
        EXPECT_LE(done.size(), max_count);
        EXPECT_EQ(done.front().gone, collapses.front().gone);
        PerVertex<char> touched = none;
        for (const DoneCollapse& collapse : done) {
            EXPECT_EQ(std::exchange(touched[collapse.gone], 1), 0);
            for (const VertexId u : scene.network.ring(collapse.gone))
                EXPECT_EQ(std::exchange(touched[u], 1), 0);
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

TEST_F(OnACube, ReduceDenselyRemovesOnlyWhatIsAsMeasured) {
    for (const std::size_t max_count : {1, 20, 10000}) {
        network = scene.network;
        const auto done = reduce_densely(network, collapses, static_cast<int>(max_count), none);
        expect_sound(done.size());
        EXPECT_LE(done.size(), max_count);
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

void expect_refined(const Shape& shape, int vertices) {
    const Network before = network_of(shape);
    Network network = before;
    EXPECT_EQ(refine(network, vertices, NewVertices::curved, unwatched()), vertices - before.vertex_count());
    EXPECT_EQ(network.vertex_count(), vertices);
    EXPECT_EQ(topology_of(network), topology_of(before));
    const PerVertex<VertexId> sources = nearest_vertices(VertexPlaces(before), network);
    for (const VertexId v : before.vertices()) {
        EXPECT_EQ(network.position(v), before.position(v));
        EXPECT_EQ(sources[v], v);
    }
}

/// (shortest, longest)
std::pair<float, float> edge_lengths(const Network& network) {
    std::pair<float, float> result(1, 0);
    for (const VertexId v : network.vertices())
        for (const VertexId u : network.ring(v)) {
            const float length = (network.position(u) - network.position(v)).Norm();
            result = {std::min(result.first, length), std::max(result.second, length)};
        }
    return result;
}

TEST(Refine, ReachesTheNumberAndKeepsTopologyAndVertices) {
    expect_refined(shapes::icosphere(2), 163);
    expect_refined(shapes::icosphere(2), 2000);
    expect_refined(shapes::torus_grid(12, 8), 1000);
    expect_refined(shapes::bipyramid(14), 1000);
}

TEST(Refine, SplitsBoundaryEdgesToo) {
    expect_refined(shapes::grid(5, 5), 2000);
    expect_refined(shapes::tube(8, 3), 1000);
    Network network = network_of(shapes::grid(5, 5));
    refine(network, 2000, NewVertices::curved, unwatched());
    // A boundary edge was .25 or more; edges of an even mesh are about .024.
    EXPECT_LT(edge_lengths(network).second, 0.06);
}

/// On a ball with even vertices only noise, of up to a fifth of an edge, says where a vertex would be better.
TEST(Redistribution, FollowsNoNoise) {
    const TargetSpace target = target_of(shapes::sphere_cloud(50000, 0.015));
    Network network = network_in_frame(target, shapes::icosphere(4));
    Random random(1);
    Fitter fitter(network, choose_points(target, 100000, random), FitOptions(), one_thread());
    Surface surface(network);
    PointsByFace points = fitter.locate_points(surface);
    const std::vector<Triangle> before = network.faces();
    fitter.redistribute_vertices(surface, points);
    int kept = 0;
    const std::set<Triangle> faces(before.begin(), before.end());
    for (const Triangle& f : network.faces()) kept += faces.count(f) > 0 ? 1 : 0;
    EXPECT_GT(kept, 0.99 * static_cast<double>(before.size()));
    EXPECT_EQ(network.validate(), "");
}

TEST(Refine, EndsWhenProgressAsksToStop) {
    Watch once(1);
    Network network = network_of(shapes::icosphere(2));
    EXPECT_GT(refine(network, 5000, NewVertices::curved, once), 0);
    EXPECT_EQ(once.calls, 2);
    EXPECT_LT(network.vertex_count(), 5000);
    EXPECT_EQ(network.validate(), "");
}

TEST(Refine, CurvesTheSurfaceAndEvensTheEdges) {
    Network network = network_of(shapes::icosphere(1));
    refine(network, 500, NewVertices::curved, unwatched());
    for (const VertexId v : network.vertices())
        EXPECT_NEAR(network.position(v).Norm(), 1, 0.02) << "middles of edges are up to .05 inside";
    refine(network, 1000, NewVertices::curved, unwatched());
    const auto [shortest, longest] = edge_lengths(network);
    EXPECT_LT(longest, 4 * shortest);
}

}  // namespace neuralmesh::redistribute_test
