// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Displacements within the limits are kept; larger ones are shortened until every face obeys the face rules.
#include "vcg_core/fit/move_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "tests/unit/fit/fit_scene.h"
#include "vcg_core/fit/face_rules.h"

namespace neuralmesh {
namespace {

PerVertex<Vector3> random_displacements(int slots, float size, std::uint64_t seed) {
    Random random(seed);
    PerVertex<Vector3> result(slots, Vector3::Zero());
    for (Vector3& u : result) u = size * to_eigen(vcg::Point3f::Construct(shapes::in_ball(random)));
    return result;
}

float quality(const Surface& surface, int f) {
    return triangle_quality(surface.corner(f, 0), surface.corner(f, 1), surface.corner(f, 2));
}

void expect_within_rules(const Surface& before, const Surface& after) {
    for (int f = 0; f < before.face_count(); ++f) {
        const Vector3 normal = unit_normal(after, f);
        EXPECT_GT(normal.dot(unit_normal(before, f)), 0.3F);
        EXPECT_GE(quality(after, f), std::min(0.06F, 0.9F * quality(before, f)));
        const Triangle& face = before.faces[f];
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = face[k];
            const VertexId b = face[(k + 1) % 3];
            const float fold = normal.dot(normal_beyond(after, a, b));
            EXPECT_GE(fold, std::min(-0.6F, unit_normal(before, f).dot(normal_beyond(before, a, b))) - 1e-5F);
        }
    }
}

TEST(MoveLimits, LeavesSmallDisplacementsAlone) {
    ThreadTeam team(2);
    const Network network = referee::network_of(shapes::icosphere(3));
    const Surface surface(network);
    const PerVertex<Vector3> u = random_displacements(network.slot_count(), 0.01F, 1);
    const PerVertex<Vector3> moved = MoveLimits(network, surface, team).bounded(u);
    for (VertexId v : network.vertices()) EXPECT_EQ(moved[v], surface.positions[v] + u[v]);
}

TEST(MoveLimits, BoundsLargeDisplacements) {
    ThreadTeam team(2);
    const Network network = referee::network_of(shapes::icosphere(3), 0.01);
    const Surface surface(network);
    const MoveLimits limits(network, surface, team);
    for (float size : {0.1F, 1.0F, 100.0F}) {
        Surface after = surface;
        after.positions = limits.bounded(random_displacements(network.slot_count(), size, 2));
        expect_within_rules(surface, after);
        int moved = 0;
        for (VertexId v : network.vertices()) {
            float mean = 0;
            for (VertexId u : network.ring(v)) mean += (surface.positions[u] - surface.positions[v]).norm();
            mean /= static_cast<float>(network.ring(v).valence);
            const float move = (after.positions[v] - surface.positions[v]).norm();
            EXPECT_LE(move, 0.2501F * mean);
            moved += move > 0 ? 1 : 0;
        }
        EXPECT_GT(moved, network.vertex_count() / 2);
    }
}

TEST(MoveLimits, DoesNotMoveAVertexByNaN) {
    ThreadTeam team(2);
    const Network network = referee::network_of(shapes::icosphere(2));
    const Surface surface(network);
    PerVertex<Vector3> u(network.slot_count(), Vector3(0.01F, 0, 0));
    u[3][1] = std::numeric_limits<float>::quiet_NaN();
    const PerVertex<Vector3> moved = MoveLimits(network, surface, team).bounded(u);
    EXPECT_EQ(moved[3], surface.positions[3]);
    for (const VertexId v : network.vertices())
        if (v != 3) {  // nor does it hold those beside it
            EXPECT_NE(moved[v], surface.positions[v]) << v;
        }
}

// A flat box whose lid would move through its floor.
TEST(MoveLimits, ShortensUntilTheGuardAccepts) {
    shapes::Shape box = shapes::icosphere(3);
    for (vcg::Point3d& p : box.positions) p[2] *= 0.02;
    const Network network = referee::network_of(box);
    const Surface surface(network);
    ThreadTeam team(2);
    ASSERT_TRUE(self_crossings(surface, team).empty());
    PerVertex<Vector3> u(network.slot_count(), Vector3::Zero());
    for (VertexId v : network.vertices())
        if (surface.positions[v][2] > 0) u[v] = Vector3(0, 0, -0.025F);
    const MoveLimits limits(network, surface, team);
    Surface after = surface;
    after.positions = limits.bounded(u);
    EXPECT_FALSE(self_crossings(after, team).empty());
    CrossingGuard guard;
    after.positions = limits.without_crossings(u, guard, team);
    EXPECT_TRUE(self_crossings(after, team).empty());
    EXPECT_NE(after.positions, surface.positions);
}

TEST(FaceRules, LetABadFaceStayButNotGetWorse) {
    constexpr FaceRules rules{0.3F, -0.6F, 0.1F, 0.9F};
    EXPECT_FALSE(rules.is_sliver(0.5F, 0.1F));
    EXPECT_TRUE(rules.is_sliver(0.5F, 0.09F));
    EXPECT_FALSE(rules.is_sliver(0.05F, 0.046F));
    EXPECT_TRUE(rules.is_sliver(0.05F, 0.044F));
    EXPECT_FALSE(rules.folds(1, -0.5F));
    EXPECT_TRUE(rules.folds(1, -0.7F));
    EXPECT_FALSE(rules.folds(-0.9F, -0.8F));
    EXPECT_TRUE(rules.folds(-0.7F, -0.8F));
    EXPECT_TRUE(rules.turns_over({0, 0, 1}, {1, 0, 0}));
    EXPECT_FALSE(rules.turns_over({0, 0, 1}, {0, 0, 1}));
    EXPECT_TRUE(rules.is_folded(-0.61F));
    EXPECT_FALSE(rules.is_folded(-0.59F));
}

}  // namespace
}  // namespace neuralmesh
