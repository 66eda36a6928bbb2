// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Kinds of clouds that reports say other methods fail on: parts far apart, things that touch, regular grids,
// blades.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;

NeuralMesh mesh_of(const Cloud& cloud, int vertices) {
    Settings settings;
    settings.target_vertices = vertices;
    NoProgress progress;
    NeuralMesh mesh = reconstruct(soundness::target_of(cloud), settings, progress);
    soundness::expect_exact(mesh, settings);
    return mesh;
}

void add(const Cloud& part, double factor, const vcg::Point3d& offset, Cloud& cloud) {
    for (const vcg::Point3d& p : part) cloud.push_back(p * factor + offset);
}

/// Turned, so that nothing follows an axis; with -1 turned back.
Cloud turned(Cloud cloud, double turns = 1) {
    vcg::Matrix44d turn;
    turn.SetRotateRad(0.7 * turns, vcg::Point3d(1, 2, 3));
    for (vcg::Point3d& p : cloud) p = turn * p;
    return cloud;
}

TEST(PartsFarApart, AreLearnedAtTheirOwnScale) {
    constexpr double kDistance = 10000;
    const vcg::Point3d there(kDistance, 0, 0);
    Cloud cloud;
    add(shapes::sphere_cloud(2000), 1, {0, 0, 0}, cloud);
    add(shapes::sphere_cloud(8000, 0, 2), 2, there, cloud);
    const NeuralMesh mesh = mesh_of(cloud, 500);
    EXPECT_EQ(mesh.report.components, 2);
    int of_small = 0;
    for (const vcg::Point3d& p : mesh.positions) {
        const bool small = p[0] < kDistance / 2;
        of_small += small ? 1 : 0;
        const double size = small ? 1 : 2;
        EXPECT_NEAR((small ? p : p - there).Norm() / size, 1, 0.04);
    }
    // A fifth of the area; the smaller one bends more.
    EXPECT_GE(of_small, 100);
    EXPECT_LE(of_small, 160);
}

TEST(ThingsThatTouch, HaveNoFalseHandles) {
    const Cloud slab = shapes::box_cloud(12000, {5, 5, 0.4});

    Cloud standing;
    for (const vcg::Point3d& p : shapes::torus_cloud(6000)) standing.emplace_back(p[0], p[2], p[1] + 1.6);
    add(slab, 1, {0, 0, 0}, standing);
    EXPECT_EQ(mesh_of(turned(standing), 800).report.genus, 1) << "a ring on its edge";
    Cloud ball = slab;
    add(shapes::sphere_cloud(4000), 1, {0, 0, 1.2}, ball);
    EXPECT_EQ(mesh_of(turned(ball), 800).report.genus, 0) << "a ball";
}

/// The points of a lattice on the surface of a cube with edges of so many steps.
Cloud grid(int steps) {
    Cloud cloud;
    for (int x = 0; x <= steps; ++x)
        for (int y = 0; y <= steps; ++y)
            for (int z = 0; z <= steps; ++z)
                if (x % steps == 0 || y % steps == 0 || z % steps == 0) cloud.emplace_back(x, y, z);
    return cloud;
}

TEST(RegularGrids, AreLearnedWithinATwentiethOfAStep) {
    constexpr int kSteps = 10;
    ASSERT_EQ(grid(kSteps).size(), 602U);
    for (const int vertices : {100, 200}) {
        SCOPED_TRACE(vertices);
        const NeuralMesh mesh = mesh_of(turned(grid(kSteps)), vertices);
        EXPECT_NEAR(soundness::volume_of(mesh), 1000, 10);
        EXPECT_EQ(mesh.report.genus, 0);
        EXPECT_LT(mesh.report.rms_error, 100 * 0.05 / (kSteps * std::sqrt(3)));
    }
}

TEST(RegularGrids, HaveStraightEdges) {
    constexpr int kSteps = 40;

    // Ten points for each vertex, which an edge of the shape needs.
    constexpr int kVertices = kSteps * kSteps * 6 / 10;
    const NeuralMesh mesh = mesh_of(turned(grid(kSteps)), kVertices);
    int beside = 0;
    for (const vcg::Point3d& p : turned(mesh.positions, -1))
        for (int k = 0; k < 3; ++k) beside += p[k] < -0.1 || p[k] > kSteps + 0.1 ? 1 : 0;
    EXPECT_LE(beside, kVertices / 50) << "vertices stick out of the cube by a tenth of a step";
}

/// Uniform on the surface of a box, which shapes::box_cloud() is not if its sides differ.
Cloud blade(double thickness, double spacing) {
    const vcg::Point3d edges(1, 0.3, thickness);
    Random random(1);
    Cloud cloud;
    for (int k = 0; k < 3; ++k) {
        const double area = 2 * edges[(k + 1) % 3] * edges[(k + 2) % 3];
        for (int i = 0; i < static_cast<int>(area / (spacing * spacing)); ++i) {
            vcg::Point3d p = shapes::in_cube(random);
            p[k] = random.below(2) == 0 ? -1 : 1;
            for (int j = 0; j < 3; ++j) p[j] *= edges[j] / 2;
            cloud.push_back(p);
        }
    }
    return cloud;
}

TEST(Blades, AreAsThickAsTheirPoints) {
    constexpr double kThickness = 0.02;
    const NeuralMesh mesh = mesh_of(turned(blade(kThickness, kThickness / 3)), 500);
    EXPECT_NEAR(soundness::volume_of(mesh) / (0.3 * kThickness), 1, 0.01);
    EXPECT_LT(mesh.report.rms_error, 1.05);
}

}  // namespace
}  // namespace neuralmesh
