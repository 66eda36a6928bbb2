// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/redistribute.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/mesh/self_crossings.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

void expect_refined(const shapes::Shape& shape, int vertices) {
    const Network before = referee::network_of(shape);
    Network network = before;
    NoProgress progress;
    EXPECT_EQ(refine(network, vertices, NewVertices::curved, progress), vertices - before.vertex_count());
    EXPECT_EQ(network.vertex_count(), vertices);
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.genus(), before.genus());
    EXPECT_EQ(network.component_count(), before.component_count());
    EXPECT_EQ(network.boundary_loop_count(), before.boundary_loop_count());
    const PerVertex<VertexId> sources = nearest_vertices(VertexPlaces(before), network);
    for (const VertexId v : before.vertices()) {
        EXPECT_EQ(network.position(v), before.position(v));
        EXPECT_EQ(sources[v], v);
    }
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
    Network network = referee::network_of(shapes::grid(5, 5));
    NoProgress progress;
    refine(network, 2000, NewVertices::curved, progress);
    float longest = 0;  // a boundary edge was .25 or more; edges of an even mesh are about .024
    for (const VertexId v : network.vertices())
        for (const VertexId u : network.ring(v))
            longest = std::max(longest, (network.position(u) - network.position(v)).Norm());
    EXPECT_LT(longest, 0.06);
}

TEST(Refine, EndsWhenProgressAsksToStop) {
    class Once : public Progress {
    public:
        bool operator()(double /*fraction*/, const char* /*text*/) override { return calls++ == 0; }
        int calls = 0;
    } once;
    Network network = referee::network_of(shapes::icosphere(2));
    EXPECT_GT(refine(network, 5000, NewVertices::curved, once), 0);
    EXPECT_EQ(once.calls, 2);
    EXPECT_LT(network.vertex_count(), 5000);
    EXPECT_EQ(network.validate(), "");
}

TEST(Refine, CurvesTheSurface) {
    Network network = referee::network_of(shapes::icosphere(1));
    NoProgress progress;
    refine(network, 500, NewVertices::curved, progress);
    for (const VertexId v : network.vertices())
        EXPECT_NEAR(network.position(v).Norm(), 1, 0.02) << "middles of edges are up to .05 inside";
}

TEST(Refine, EvensTheEdges) {
    Network network = referee::network_of(shapes::icosphere(1));
    NoProgress progress;
    refine(network, 1000, NewVertices::curved, progress);
    float shortest = 1;
    float longest = 0;
    for (const VertexId v : network.vertices())
        for (const VertexId u : network.ring(v)) {
            const float length = (network.position(u) - network.position(v)).Norm();
            shortest = std::min(shortest, length);
            longest = std::max(longest, length);
        }
    EXPECT_LT(longest, 4 * shortest);
}

// 400 points carry 200 vertices.
TEST(FewPoints, MakeASmoothMeshOfAllVerticesAskedFor) {
    Settings settings;
    settings.target_vertices = 3000;
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(soundness::target_of(shapes::sphere_cloud(400)), settings, progress);
    EXPECT_EQ(mesh.report.vertices, 3000);
    EXPECT_EQ(mesh.report.genus, 0);
    EXPECT_TRUE(soundness::has_warning(mesh, "carry about 200 vertices"));
    EXPECT_LT(mesh.report.signals, 300000);
    for (const vcg::Point3d& p : mesh.positions) EXPECT_NEAR(p.Norm(), 1, 0.03);
}

TEST(FewPoints, MakeASmoothOpenMesh) {
    const shapes::Cloud half =
        open_shapes::cut(shapes::sphere_cloud(3000), [](const vcg::Point3d& p) { return p[2] < 0; });
    Settings settings;
    settings.target_vertices = 4000;
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(soundness::target_of(half), settings, progress);
    soundness::expect_exact(mesh, settings);
    EXPECT_EQ(mesh.report.boundary_loops, 1);
    EXPECT_TRUE(soundness::has_warning(mesh, "carry about"));
    for (const vcg::Point3d& p : mesh.positions) EXPECT_NEAR(p.Norm(), 1, 0.03);
    std::vector<vcg::Point3f> positions;
    for (const vcg::Point3d& p : mesh.positions) positions.push_back(vcg::Point3f::Construct(p));
    ThreadTeam team(1);
    EXPECT_TRUE(self_crossings(Surface(Network(positions, mesh.faces)), team).empty());
}

}  // namespace
}  // namespace neuralmesh
