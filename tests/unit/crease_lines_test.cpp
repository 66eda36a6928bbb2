// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Crease lines of cubes, whose creases are known, and of surfaces without any.
#include "vcg_core/output/crease_lines.h"

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/learning/two_planes.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh::crease_lines_test {

/// Of a point near the cube's surface from the nearest edge of the cube.
double distance_from_edge(const vcg::Point3f& p) {
    std::array<double, 3> off{};
    for (int k = 0; k < 3; ++k)
        off[static_cast<std::size_t>(k)] = std::abs(std::abs(static_cast<double>(p[k])) - 1);
    std::sort(off.begin(), off.end());
    return std::hypot(off[0], off[1]);
}

constexpr int kPieces = 8;  ///< edges of the mesh along an edge of the cube

/// The cube [-1, 1]^3, each side a grid of kPieces x kPieces squares.
Shape cube_of_pieces() { return shapes::scaled(shapes::fine_cube(3), 2); }

PerVertex<float> everywhere(const Network& network, float measure) {
    return PerVertex<float>(network.slot_count(), measure);
}

/// The graph has each edge once, and its counts are right.
void expect_consistent(const CreaseGraph& graph) {
    ASSERT_EQ(graph.positions.size(), graph.vertices.size());
    EXPECT_TRUE(std::is_sorted(graph.vertices.begin(), graph.vertices.end()));
    std::map<VertexId, std::set<VertexId>> joined;
    for (const auto& [i, j] : graph.edges) {
        ASSERT_LT(i, j);
        const VertexId a = graph.vertices.at(static_cast<std::size_t>(i));
        const VertexId b = graph.vertices.at(static_cast<std::size_t>(j));
        EXPECT_NE(a, b);
        EXPECT_TRUE(joined[a].insert(b).second);
        EXPECT_TRUE(joined[b].insert(a).second);
    }
    EXPECT_EQ(joined.size(), graph.vertices.size());
    const auto corners = std::count_if(joined.begin(), joined.end(),
                                       [](const auto& entry) { return entry.second.size() > 2; });
    EXPECT_EQ(graph.corners, corners);
}

TEST(CreaseLines, ACubeHasTwelve) {
    const Network cube = network_of(cube_of_pieces());
    const CreaseGraph graph = crease_lines(cube, everywhere(cube, 2));
    expect_consistent(graph);
    EXPECT_EQ(graph.lines, 12);
    EXPECT_EQ(graph.corners, 8);
    EXPECT_EQ(graph.edges.size(), 12u * kPieces);
    for (const vcg::Point3f& p : graph.positions) EXPECT_LT(distance_from_edge(p), 0.02);
}

TEST(CreaseLines, StayNearTheMesh) {
    // Rough sides: two planes near a vertex may meet far from both.
    const Network cube = network_of(cube_of_pieces(), 0.08);
    const Surface surface(cube);
    ThreadTeam team(1);
    const FaceTree tree(surface, team);
    const CreaseGraph graph = crease_lines(cube, everywhere(cube, 2));
    ASSERT_GT(graph.vertices.size(), 50U);
    for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
        const float squared = tree.nearest(to_eigen(graph.positions[i])).foot.squared_distance;
        EXPECT_LE(std::sqrt(squared), 0.21F * mean_edge_at(cube, graph.vertices[i]));
    }
}

TEST(CreaseLines, NoiseMovesThemLessThanTheVertices) {
    const Network cube = network_of(cube_of_pieces(), 0.02);
    const CreaseGraph graph = crease_lines(cube, everywhere(cube, 2));
    expect_consistent(graph);
    EXPECT_EQ(graph.lines, 12);
    double of_lines = 0;
    double of_vertices = 0;
    for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
        of_lines += distance_from_edge(graph.positions[i]);
        of_vertices += distance_from_edge(cube.position(graph.vertices[i]));
    }
    EXPECT_LT(of_lines, 0.8 * of_vertices);
}

TEST(CreaseLines, VerticesOfALowMeasureAreOnNone) {
    const Network cube = network_of(cube_of_pieces());
    const CreaseGraph graph = crease_lines(cube, everywhere(cube, 0.3F));
    EXPECT_TRUE(graph.vertices.empty());
    EXPECT_EQ(graph.lines, 0);
}

TEST(CreaseLines, AGapOfTwoEdgesIsBridged) {
    const Network cube = network_of(cube_of_pieces());
    PerVertex<float> measure = everywhere(cube, 2);
    for (const VertexId v : cube.vertices()) {
        const vcg::Point3f p = cube.position(v);
        if (p[0] == 1 && p[1] == 1 && p[2] == 0) measure[v] = 0.5F;
    }
    const CreaseGraph graph = crease_lines(cube, measure);
    EXPECT_EQ(graph.lines, 12);
    EXPECT_EQ(graph.edges.size(), 12u * kPieces);
}

TEST(CreaseLines, RimsOfATubeAreTwoClosedOnesIfItHasLids) {
    constexpr int kAround = 14;
    Shape tube = shapes::tube(kAround, 6);
    const Network open = network_of(tube);
    EXPECT_EQ(crease_lines(open, everywhere(open, 2)).lines, 0);

    const auto last = static_cast<int>(tube.positions.size());
    for (const auto& loop : {0, 1}) {
        vcg::Point3d centre(0, 0, 0);
        for (int i = 0; i < kAround; ++i)
            centre += tube.positions[static_cast<std::size_t>(loop == 0 ? i : last - kAround + i)] / kAround;
        tube.positions.push_back(centre);
    }
    for (int i = 0; i < kAround; ++i) {
        const int next = (i + 1) % kAround;
        tube.faces.push_back({last, next, i});
        tube.faces.push_back({last + 1, last - kAround + i, last - kAround + next});
    }
    const Network closed = network_of(tube);
    ASSERT_EQ(closed.validate(), "");
    const CreaseGraph graph = crease_lines(closed, everywhere(closed, 2));
    expect_consistent(graph);
    EXPECT_EQ(graph.lines, 2);
    EXPECT_EQ(graph.corners, 0);
    EXPECT_EQ(graph.edges.size(), 2u * kAround);
}

}  // namespace neuralmesh::crease_lines_test
