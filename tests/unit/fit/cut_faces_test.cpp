// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Surfaces with boundary that cut themselves lose the faces that do, and no more than must be.
#include "vcg_core/fit/cut_faces.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/unit/support/crumpled.h"
#include "vcg_core/fit/redistribute.h"
#include "vcg_core/fit/sound_meshes.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {
namespace {

using shapes::Shape;

/// A level sheet and, as further vertices, \p standing turned upright, \p depth below the sheet at its lower
/// end.
Network standing_on_sheet(const Shape& standing, double depth) {
    Shape shape = shapes::grid(12, 12);
    const int offset = static_cast<int>(shape.positions.size());
    for (const vcg::Point3d& p : standing.positions)
        shape.positions.emplace_back(0.013 + 0.6 * p[0], 0.021 + 0.1 * p[0], 0.5 + p[1] - depth);
    for (const Triangle& f : standing.faces)
        shape.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
    return referee::network_of(shape);
}

std::vector<SelfCrossing> removed_from(Network& network, int threads = 1) {
    ThreadTeam team(threads);
    std::vector<SelfCrossing> left = crossings(Surface(network), threads);
    const int faces = network.face_count();
    const int removed = remove_cut_faces(network, left, team);
    EXPECT_EQ(removed, faces - network.face_count());
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(left, crossings(Surface(network), 1)) << "the plain search of the whole surface";
    return left;
}

TEST(CutFaces, ABoundaryThatPiercesASheetDrawsBack) {
    Network network = standing_on_sheet(shapes::grid(8, 8), 0.05);
    ASSERT_FALSE(crossings(Surface(network), 1).empty());
    EXPECT_TRUE(removed_from(network).empty());
    EXPECT_EQ(network.component_count(), 2);
    EXPECT_EQ(network.boundary_loop_count(), 2);
    EXPECT_EQ(network.genus(), 0);
    const int sheet_faces = 2 * 11 * 11, row = 2 * 7;
    EXPECT_GE(network.face_count(), sheet_faces + 6 * row) << "only the lowest row of the standing part goes";
    for (VertexId v = 0; v < 144; ++v) EXPECT_TRUE(network.alive(v)) << "the sheet stays";
}

TEST(CutFaces, AStrandIsBroken) {
    Network network = standing_on_sheet(shapes::grid(2, 12), 0.5);
    EXPECT_TRUE(removed_from(network).empty());
    EXPECT_EQ(network.component_count(), 3);
    EXPECT_EQ(network.genus(), 0);
    for (VertexId v = 0; v < 144; ++v) EXPECT_TRUE(network.alive(v)) << "the sheet stays";
}

TEST(CutFaces, AFoldInsideIsCollapsedAndKeepsTheTopology) {
    Network network = referee::network_of(shapes::grid(9, 9), 0.005);
    const VertexId middle = 40;
    network.set_position(middle, network.position(middle) + vcg::Point3f(0.3F, 0.02F, 0));
    ASSERT_FALSE(crossings(Surface(network), 1).empty());
    EXPECT_TRUE(removed_from(network).empty());
    EXPECT_EQ(network.boundary_loop_count(), 1);
    EXPECT_EQ(network.genus(), 0);
    EXPECT_GT(network.vertex_count(), 81 - 10);
}

TEST(CutFaces, ATangleLosesATenthOfItsFacesAtMost) {
    for (const double noise : {0.3, 1.0}) {
        Network network = referee::network_of(shapes::grid(15, 15), noise);
        const int faces = network.face_count();
        EXPECT_FALSE(removed_from(network).empty());
        EXPECT_GE(network.face_count(), faces - faces / 10 - 12);
    }
}

TEST(SoundStart, KeepsTheNumberOfVertices) {
    for (const double depth : {0.05, 0.12}) {
        Network network = standing_on_sheet(shapes::grid(8, 8), depth);
        const Network before = network;
        ThreadTeam team(1);
        NoProgress progress;
        const std::vector<SelfCrossing> left = *make_sound(network, team, progress);
        EXPECT_EQ(left, crossings(Surface(network), 1));
        EXPECT_TRUE(crossings(Surface(network), 1).empty());
        EXPECT_EQ(network.validate(), "");
        EXPECT_EQ(network.vertex_count(), before.vertex_count());
        EXPECT_EQ(network.component_count(), 2);
    }
}

TEST(SoundStart, OfAClosedSurfaceLosesNoFace) {
    Network network = crumpled_sphere(1.5);
    const std::vector<Triangle> faces = network.faces();
    ThreadTeam team(1);
    NoProgress progress;
    EXPECT_FALSE(make_sound(network, team, progress)->empty());
    EXPECT_EQ(network.faces(), faces);
}

}  // namespace
}  // namespace neuralmesh
