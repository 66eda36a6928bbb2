// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moves whose harm to a surface is known, on points of a sphere and of a noisy plane.
#include "vcg_core/fit/harmful_moves.h"

#include <gtest/gtest.h>

#include "tests/unit/fit/fit_scene.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

constexpr float kEdge = 0.15F;  // of icosphere(3) of radius 1

/// A sphere of the given radius, with points on the unit sphere.
FitScene sphere_scene(double radius) {
    return {referee::network_of(shapes::scaled(shapes::icosphere(3), radius)), shapes::sphere_cloud(20000)};
}

/// Moves \p v by \p distance outward.
void move_outward(Surface& surface, VertexId v, float distance) {
    surface.positions[v] += distance * surface.positions[v].normalized();
}

Surface shortened(const FitScene& scene, Surface moved, int threads = 1) {
    ThreadTeam team(threads);
    shorten_harmful_moves(scene.network, scene.surface, moved, scene.points, team);
    return moved;
}

void expect_same(const Network& network, const Surface& a, const Surface& b) {
    for (const VertexId v : network.vertices()) EXPECT_EQ(a.positions[v], b.positions[v]) << v;
}

TEST(HarmfulMoves, AreUndoneWhereAllOfThemHarms) {
    const FitScene scene = sphere_scene(1.005);
    Surface moved = scene.surface;
    for (const VertexId v : {3, 300, 600}) move_outward(moved, v, 0.3F * kEdge);
    expect_same(scene.network, shortened(scene, moved), scene.surface);
}

TEST(HarmfulMoves, AreHalvedWhereTheyGoTooFar) {
    const FitScene scene = sphere_scene(0.99);
    Surface moved = scene.surface;
    for (const VertexId v : scene.network.vertices()) move_outward(moved, v, 0.012F);
    const Surface good = moved;
    constexpr VertexId kFar = 300;
    move_outward(moved, kFar, 0.06F);
    const Surface found = shortened(scene, moved);
    const Vector3& from = scene.surface.positions[kFar];
    EXPECT_LT((found.positions[kFar] - 0.5F * (from + moved.positions[kFar])).norm(), 1e-6F);
    const Ring& ring = scene.network.ring(kFar);
    for (const VertexId v : scene.network.vertices()) {
        if (v == kFar || ring.find(v) >= 0) continue;
        EXPECT_EQ(found.positions[v], good.positions[v]) << v;
    }
}

TEST(HarmfulMoves, AreNotThoseToThePoints) {
    const FitScene scene = sphere_scene(0.9);
    Surface moved = scene.surface;
    for (const VertexId v : scene.network.vertices()) move_outward(moved, v, 0.1F);
    expect_same(scene.network, shortened(scene, moved), moved);
}

// Under noise every small move brings some points closer and others not.
TEST(HarmfulMoves, AreNotThoseThatThePointsDoNotTellFromGood) {
    constexpr double kNoise = 0.02;
    Random random(2);
    shapes::Cloud cloud = shapes::plane_cloud(20000);
    for (vcg::Point3d& p : cloud) p[2] += kNoise * shapes::signed_unit(random);
    const FitScene scene(referee::network_of(shapes::grid(17, 17)), cloud);
    Surface moved = scene.surface;
    for (const VertexId v : scene.network.vertices())
        moved.positions[v][2] += static_cast<float>(0.05 * kNoise * shapes::signed_unit(random));
    const Surface found = shortened(scene, moved);
    int count = 0;
    for (const VertexId v : scene.network.vertices()) count += found.positions[v] != moved.positions[v];
    EXPECT_LT(count, 0.4 * scene.network.vertex_count());
}

TEST(HarmfulMoves, AreTheSameForAnyNumberOfThreads) {
    const FitScene scene = sphere_scene(1.002);
    Surface moved = scene.surface;
    Random random(7);
    for (const VertexId v : scene.network.vertices())
        move_outward(moved, v, static_cast<float>(0.01 * shapes::signed_unit(random)));
    expect_same(scene.network, shortened(scene, moved, 1), shortened(scene, moved, 3));
}

}  // namespace
}  // namespace neuralmesh
