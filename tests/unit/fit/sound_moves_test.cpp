// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Long moves reach their places, and stop where the surface would cut itself.
#include "vcg_core/fit/sound_meshes.h"

#include <gtest/gtest.h>

#include "tests/unit/support/crumpled.h"
#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

/// A ball with a concentric hollow: the two sides of a wall from \p inner to 1.
Network hollow_ball(double inner) {
    shapes::Shape ball = shapes::icosphere(3);
    shapes::Shape hollow = shapes::scaled(shapes::icosphere(3), inner);
    for (auto& face : hollow.faces) std::swap(face[1], face[2]);
    shapes::append(ball, hollow, {0, 0, 0});
    return referee::network_of(ball);
}

/// Moves of all vertices to the spheres of radius \p outer and \p inner.
PerVertex<Vector3> moves_to(const Network& network, float middle, float outer, float inner) {
    PerVertex<Vector3> moves(network.slot_count(), Vector3::Zero());
    for (const VertexId v : network.vertices()) {
        const Vector3 p = to_eigen(network.position(v));
        moves[v] = p * ((p.norm() > middle ? outer : inner) / p.norm()) - p;
    }
    return moves;
}

TEST(SoundMoves, MakeAWallThinnerThanItsEdgesAreLong) {
    Network network = hollow_ball(0.6);
    ThreadTeam team(1);
    move_soundly(network, moves_to(network, 0.8F, 0.82F, 0.78F), team);
    EXPECT_EQ(network.validate(), "");
    EXPECT_TRUE(cut_faces(network).empty());
    int arrived = 0;
    for (const VertexId v : network.vertices()) {
        const float radius = to_eigen(network.position(v)).norm();
        arrived += std::abs(radius - (radius > 0.8F ? 0.82F : 0.78F)) < 1e-3F ? 1 : 0;
    }
    EXPECT_EQ(arrived, network.vertex_count());
}

TEST(SoundMoves, StopBeforeTheSidesCross) {
    Network network = hollow_ball(0.6);
    const std::vector<Triangle> faces = network.faces();
    PerVertex<Vector3> moves(network.slot_count(), Vector3::Zero());
    for (const VertexId v : network.vertices())
        if (to_eigen(network.position(v)).norm() < 0.8F) moves[v] = Vector3(0.7F, 0, 0);
    ThreadTeam team(1);
    move_soundly(network, moves, team);
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.faces(), faces);
    EXPECT_TRUE(cut_faces(network).empty());
    float farthest = 0;
    for (const VertexId v : network.vertices())
        if (moves[v] != Vector3(0, 0, 0)) farthest = std::max(farthest, network.position(v)[0]);
    EXPECT_GT(farthest, 0.8F) << "the hollow does come closer to the outside";
    EXPECT_LT(farthest, 1);
}

}  // namespace
}  // namespace neuralmesh
