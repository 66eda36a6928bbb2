// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Vertices move to the ridge of a roof, whose place is known; those on smooth or noisy surfaces stay.
#include "vcg_core/fit/crease_moves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/fit/fit_scene.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

constexpr int kColumns = 17;
constexpr double kEdge = 1.0 / (kColumns - 1);
constexpr double kRidge = 0.2 * kEdge;  ///< x of the ridge, beside a column of vertices

double roof(double x) { return -std::abs(x - kRidge); }

/// A mesh whose vertices lie on the roof, with points on it that \p noise moves up or down.
FitScene roof_scene(double noise = 0) {
    shapes::Shape mesh = shapes::grid(kColumns, kColumns);
    for (vcg::Point3d& p : mesh.positions) p[2] = roof(p[0]);
    shapes::Cloud cloud = shapes::plane_cloud(20000);
    Random random(5);
    for (vcg::Point3d& p : cloud) {
        p[2] = roof(p[0]) + noise * shapes::signed_unit(random);
    }
    return {referee::network_of(mesh), cloud};
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
        const bool near = std::abs(static_cast<double>(p[0]) - kRidge) < 0.3 * kEdge;
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
    const double noise = 0.05 * kEdge;
    const FitScene scene = roof_scene(noise);
    expect_ridge_reached(scene, moves_of(scene, noise), 0.03 * kEdge);
}

TEST(CreaseMoves, NothingMovesOnASmoothSurface) {
    const FitScene scene(referee::network_of(shapes::icosphere(3)), shapes::sphere_cloud(20000));
    EXPECT_EQ(count_moved(moves_of(scene)), 0);
}

TEST(CreaseMoves, NoiseIsNoCrease) {
    const double noise = 0.3 * kEdge;
    shapes::Cloud cloud = shapes::plane_cloud(20000);
    Random random(6);
    for (vcg::Point3d& p : cloud) p += vcg::Point3d(0, 0, noise * shapes::signed_unit(random));
    const FitScene scene(referee::network_of(shapes::grid(kColumns, kColumns), noise), cloud);
    EXPECT_EQ(count_moved(moves_of(scene, noise)), 0);
}

TEST(CreaseMoves, NothingMovesWithMuchNoise) {
    const FitScene scene = roof_scene();
    EXPECT_GT(count_moved(moves_of(scene, 0.1 * kEdge)), 0);
    EXPECT_EQ(count_moved(moves_of(scene, 0.5 * kEdge)), 0);
}

}  // namespace
}  // namespace neuralmesh
