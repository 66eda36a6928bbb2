// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Folds of a surface that was seen from one side are smoothed out, and no step of the fit makes new ones.
#include "vcg_core/fit/sound_meshes.h"

#include <gtest/gtest.h>

#include "tests/unit/support/referee.h"
#include "vcg_core/fit/move_limits.h"

namespace neuralmesh {
namespace {

const vcg::Point3f kAbove(0, 0, 1e6F);
constexpr int kSide = 21;
constexpr float kEdge = 1.0F / (kSide - 1);
constexpr VertexId kMiddle = kSide * kSide / 2;

/// A square whose middle vertex has passed its neighbour, and lies above it.
Network folded_square() {
    Network network = referee::network_of(shapes::grid(kSide, kSide));
    network.set_position(kMiddle, network.position(kMiddle) + vcg::Point3f(1.6F * kEdge, 0, kEdge));
    return network;
}

int turned_away(const Surface& surface, const vcg::Point3f& viewer) {
    int count = 0;
    for (int f = 0; f < surface.face_count(); ++f)
        count += unit_normal(surface, f).dot(to_eigen(viewer) - surface.corner(f, 0)) < 0 ? 1 : 0;
    return count;
}

TEST(Unfold, TakesOutAFoldInTheImageOfTheViewer) {
    for (const vcg::Point3f& viewer : {kAbove, vcg::Point3f(0.3F, 0.2F, 2)}) {
        Network network = folded_square();
        const Network before = network;
        ASSERT_GT(turned_away(Surface(network), viewer), 0);
        network.set_viewer(viewer);
        unfold(network);
        EXPECT_EQ(turned_away(Surface(network), viewer), 0);
        for (const VertexId v : network.vertices()) {
            const vcg::Point3f way = network.position(v) - before.position(v);
            const vcg::Point3f sight = (viewer - before.position(v)).Normalize();
            EXPECT_LT(std::abs(way * sight), 0.2F * kEdge);
            const bool far = (before.position(v) - before.position(kMiddle)).Norm() > 4 * kEdge;
            EXPECT_TRUE(!far || way == vcg::Point3f(0, 0, 0));
        }
    }
}

TEST(Unfold, LeavesASurfaceThatNobodyHasSeenAlone) {
    Network network = folded_square();
    unfold(network);
    EXPECT_EQ(network.position(kMiddle), folded_square().position(kMiddle));
}

TEST(Unfold, KeepsAnOverhang) {
    // Half of a square turned over and laid on top of the other: a sheet folded in its middle.
    Network network = referee::network_of(shapes::grid(kSide, kSide));
    for (const VertexId v : network.vertices()) {
        const vcg::Point3f p = network.position(v);
        if (p[0] > 0) network.set_position(v, {-p[0], p[1], 0.2F * std::min(p[0], 0.2F)});
    }
    const Network before = network;
    const int overhanging = turned_away(Surface(network), kAbove);
    network.set_viewer(kAbove);
    unfold(network);
    EXPECT_GT(turned_away(Surface(network), kAbove), overhanging * 8 / 10);
    for (const VertexId v : network.vertices())
        EXPECT_LT((network.position(v) - before.position(v)).Norm(), kEdge);
}

TEST(Unfold, IsNotUndoneByMoves) {
    ThreadTeam team(1);
    Random random(1);
    Network network = referee::network_of(shapes::grid(kSide, kSide));
    for (const VertexId v : network.vertices()) {  // steep, where little turns a face away
        const vcg::Point3f p = network.position(v);
        network.set_position(v, {0.05F * p[0], p[1], p[0]});
    }
    for (const bool seen : {false, true}) {
        if (seen) network.set_viewer(kAbove);
        const Surface surface(network);
        PerVertex<Vector3> moves(network.slot_count(), Vector3::Zero());
        for (Vector3& move : moves)
            move = 0.1F * kEdge * to_eigen(vcg::Point3f::Construct(shapes::in_ball(random)));
        Surface moved = surface;
        moved.positions = MoveLimits(network, surface, team).bounded(moves);
        ASSERT_EQ(turned_away(surface, kAbove), 0);
        EXPECT_EQ(turned_away(moved, kAbove) == 0, seen);
    }
}

}  // namespace
}  // namespace neuralmesh
