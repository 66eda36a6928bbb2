// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moves of the fit: within limits, to creases, and long ones that keep the surface sound.
#include "tests/unit/fit/fit_scene.h"
#include "tests/unit/support/crumpled.h"
#include "vcg_core/fit/crease_moves.h"
#include "vcg_core/fit/face_rules.h"
#include "vcg_core/fit/move_limits.h"
#include "vcg_core/fit/sound_meshes.h"

namespace neuralmesh::moves_test {

// Displacements within the limits are kept; larger ones are shortened until every face obeys the face rules.

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
    const Network network = network_of(shapes::icosphere(3));
    const Surface surface(network);
    const PerVertex<Vector3> u = random_displacements(network.slot_count(), 0.01F, 1);
    const PerVertex<Vector3> moved = MoveLimits(network, surface, team).bounded(u);
    for (VertexId v : network.vertices()) EXPECT_EQ(moved[v], surface.positions[v] + u[v]);
}

TEST(MoveLimits, BoundsLargeDisplacements) {
    ThreadTeam team(2);
    const Network network = network_of(shapes::icosphere(3), 0.01);
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
    const Network network = network_of(shapes::icosphere(2));
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
    Shape box = shapes::icosphere(3);
    for (vcg::Point3d& p : box.positions) p[2] *= 0.02;
    const Network network = network_of(box);
    const Surface surface(network);
    ThreadTeam team(2);
    ASSERT_TRUE(self_intersections(surface, team).empty());
    PerVertex<Vector3> u(network.slot_count(), Vector3::Zero());
    for (VertexId v : network.vertices())
        if (surface.positions[v][2] > 0) u[v] = Vector3(0, 0, -0.025F);
    const MoveLimits limits(network, surface, team);
    Surface after = surface;
    after.positions = limits.bounded(u);
    EXPECT_FALSE(self_intersections(after, team).empty());
    IntersectionGuard guard;
    after.positions = limits.without_intersections(u, guard, team);
    EXPECT_TRUE(self_intersections(after, team).empty());
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

// Vertices move to the ridge of a roof, whose place is known; those on smooth or noisy surfaces stay.

constexpr int kColumns = 17;
constexpr double kStep = 1.0 / (kColumns - 1);
constexpr double kRidge = 0.2 * kStep;  ///< x of the ridge, beside a column of vertices

double roof(double x) { return -std::abs(x - kRidge); }

/// A mesh whose vertices lie on the roof, with points on it that \p noise moves up or down.
FitScene roof_scene(double noise = 0) {
    Shape mesh = shapes::grid(kColumns, kColumns);
    for (vcg::Point3d& p : mesh.positions) p[2] = roof(p[0]);
    Cloud cloud = shapes::plane_cloud(20000);
    Random random(5);
    for (vcg::Point3d& p : cloud) {
        p[2] = roof(p[0]) + noise * shapes::signed_unit(random);
    }
    return {network_of(mesh), cloud};
}

PerVertex<Vector3> moves_of(const FitScene& scene, double noise = 0, int threads = 1) {
    ThreadTeam team(threads);
    const PerVertex<float> variances(scene.network.slot_count(), static_cast<float>(noise * noise / 3));
    return moves_to_creases(scene.network, scene.surface, scene.points, variances, team);
}

int count_moved(const PerVertex<Vector3>& moves) {
    return static_cast<int>(
        std::count_if(moves.begin(), moves.end(), [](const Vector3& way) { return way.norm() > 0; }));
}

bool is_inside(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    return ring.open == 0 &&
           std::all_of(ring.begin(), ring.end(), [&](VertexId u) { return network.ring(u).open == 0; });
}

void expect_ridge_reached(const FitScene& scene, const PerVertex<Vector3>& moves, double tolerance) {
    for (const VertexId v : scene.network.vertices()) {
        const Vector3& p = scene.surface.positions[v];
        const bool near = std::abs(static_cast<double>(p[0]) - kRidge) < 0.3 * kStep;
        if (!near || !is_inside(scene.network, v)) {
            EXPECT_EQ(moves[v], Vector3::Zero()) << p.transpose();
        } else {
            const Vector3 there = p + moves[v];
            EXPECT_NEAR(static_cast<double>(there[0]), kRidge, tolerance);
            EXPECT_NEAR(static_cast<double>(there[1]), static_cast<double>(p[1]), tolerance);
            EXPECT_NEAR(static_cast<double>(there[2]), 0, tolerance);
        }
    }
}

TEST(CreaseMoves, VerticesBesideARidgeReachIt) {
    const FitScene scene = roof_scene();
    expect_ridge_reached(scene, moves_of(scene), 1e-4);
}

TEST(CreaseMoves, NoiseBelowTheCreaseDoesNotMatter) {
    const double noise = 0.05 * kStep;
    const FitScene scene = roof_scene(noise);
    expect_ridge_reached(scene, moves_of(scene, noise), 0.03 * kStep);
}

TEST(CreaseMoves, NothingMovesOnASmoothSurface) {
    const FitScene scene(network_of(shapes::icosphere(3)), shapes::sphere_cloud(20000));
    EXPECT_EQ(count_moved(moves_of(scene)), 0);
}

TEST(CreaseMoves, NoiseIsNoCrease) {
    const double noise = 0.3 * kStep;
    Cloud cloud = shapes::plane_cloud(20000);
    Random random(6);
    for (vcg::Point3d& p : cloud) p += vcg::Point3d(0, 0, noise * shapes::signed_unit(random));
    const FitScene scene(network_of(shapes::grid(kColumns, kColumns), noise), cloud);
    EXPECT_EQ(count_moved(moves_of(scene, noise)), 0);
}

TEST(CreaseMoves, NothingMovesWithMuchNoise) {
    const FitScene scene = roof_scene();
    EXPECT_GT(count_moved(moves_of(scene, 0.1 * kStep)), 0);
    EXPECT_EQ(count_moved(moves_of(scene, 0.5 * kStep)), 0);
}

// Long moves reach their places, and stop where the surface would cut itself.

/// A ball with a concentric hollow: the two sides of a wall from \p inner to 1.
Network hollow_ball(double inner) {
    Shape ball = shapes::icosphere(3);
    Shape hollow = shapes::scaled(shapes::icosphere(3), inner);
    for (auto& face : hollow.faces) std::swap(face[1], face[2]);
    shapes::append(ball, hollow, {0, 0, 0});
    return network_of(ball);
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
    move_soundly(network, moves_to(network, 0.8F, 0.82F, 0.78F), one_thread());
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
    move_soundly(network, moves, one_thread());
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.faces(), faces);
    EXPECT_TRUE(cut_faces(network).empty());
    float farthest = 0;
    for (const VertexId v : network.vertices())
        if (moves[v] != Vector3(0, 0, 0)) farthest = std::max(farthest, network.position(v)[0]);
    EXPECT_GT(farthest, 0.8F) << "the hollow does come closer to the outside";
    EXPECT_LT(farthest, 1);
}

}  // namespace neuralmesh::moves_test
