// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Kinds of clouds that reports say other methods fail on: parts far apart, things that touch, regular grids,
// blades.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/unit/support/environment.h"
#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using environment::in_tiers;
using shapes::Cloud;

NeuralMesh mesh_of(const Cloud& cloud, int vertices, std::uint64_t seed = 1) {
    Settings settings;
    settings.target_vertices = vertices;
    settings.random_seed = static_cast<int>(seed);
    NoProgress progress;
    NeuralMesh mesh = reconstruct(soundness::target_of(cloud), settings, progress);
    soundness::expect_exact(mesh, settings);
    return mesh;
}

void add(const Cloud& part, double factor, const vcg::Point3d& offset, Cloud& cloud) {
    for (const vcg::Point3d& p : part) cloud.push_back(p * factor + offset);
}

/// Turned, so that nothing follows an axis; with the opposite angle turned back.
Cloud turned(Cloud cloud, double turns) {
    vcg::Matrix44d turn;
    turn.SetRotateRad(0.7 * turns, vcg::Point3d(1, 2, 3));
    for (vcg::Point3d& p : cloud) p = turn * p;
    return cloud;
}

TEST(PartsFarApart, AreLearnedAtTheirOwnScale) {
    for (const double distance : in_tiers<double>({10000}, {100, 1000})) {
        SCOPED_TRACE(distance);
        const vcg::Point3d there(distance, 0, 0);
        Cloud cloud;
        add(shapes::sphere_cloud(2000), 1, {0, 0, 0}, cloud);
        add(shapes::sphere_cloud(8000, 0, 2), 2, there, cloud);
        const NeuralMesh mesh = mesh_of(cloud, 500);
        EXPECT_EQ(mesh.report.components, 2);
        int of_small = 0;
        for (const vcg::Point3d& p : mesh.positions) {
            const bool small = p[0] < distance / 2;
            of_small += small ? 1 : 0;
            const double size = small ? 1 : 2;
            EXPECT_NEAR((small ? p : p - there).Norm() / size, 1, 0.04);
        }
        // A fifth of the area; the smaller one bends more.
        EXPECT_GE(of_small, 100);
        EXPECT_LE(of_small, 160);
    }
}

TEST(ThingsThatTouch, HaveNoFalseHandles) {
    const Cloud slab = shapes::box_cloud(12000, {5, 5, 0.4});
    for (const std::uint64_t seed : in_tiers<std::uint64_t>({1}, {2, 3, 4, 5})) {
        SCOPED_TRACE(seed);
        Cloud standing;
        for (const vcg::Point3d& p : shapes::torus_cloud(6000, 0, seed))
            standing.emplace_back(p[0], p[2], p[1] + 1.6);
        add(slab, 1, {0, 0, 0}, standing);
        EXPECT_EQ(mesh_of(turned(standing, static_cast<double>(seed)), 800, seed).report.genus, 1)
            << "a ring on its edge";
        Cloud ball = slab;
        add(shapes::sphere_cloud(4000, 0, seed), 1, {0, 0, 1.2}, ball);
        EXPECT_EQ(mesh_of(turned(ball, static_cast<double>(seed)), 800, seed).report.genus, 0) << "a ball";
    }
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
    for (const int seed : in_tiers<int>({1}, {0, 2, 3}))
        for (const int vertices : in_tiers<int>({100, 200}, {80, 300, 500, 1000})) {
            SCOPED_TRACE(std::to_string(seed) + ' ' + std::to_string(vertices));
            const NeuralMesh mesh = mesh_of(turned(grid(kSteps), seed), vertices, seed);
            EXPECT_NEAR(soundness::volume_of(mesh), 1000, 10);
            EXPECT_EQ(mesh.report.genus, 0);
            EXPECT_LT(mesh.report.rms_error, 100 * 0.05 / (kSteps * std::sqrt(3)));
        }
}

TEST(RegularGrids, HaveStraightEdges) {
    for (const int steps : in_tiers<int>({40}, {20, 60}))
        for (const int seed : in_tiers<int>({1}, {0, 2, 3})) {
            SCOPED_TRACE(std::to_string(steps) + ' ' + std::to_string(seed));
            // Ten points for each vertex, which an edge of the shape needs.
            const int vertices = steps * steps * 6 / 10;
            const NeuralMesh mesh = mesh_of(turned(grid(steps), seed), vertices, seed);
            int beside = 0;
            for (const vcg::Point3d& p : turned(mesh.positions, -seed))
                for (int k = 0; k < 3; ++k) beside += p[k] < -0.1 || p[k] > steps + 0.1 ? 1 : 0;
            EXPECT_LE(beside, vertices / 50) << "vertices stick out of the cube by a tenth of a step";
        }
}

/// Uniform on the surface of a box, which shapes::box_cloud() is not if its sides differ.
Cloud blade(double thickness, double spacing, std::uint64_t seed) {
    const vcg::Point3d edges(1, 0.3, thickness);
    Random random(seed);
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

TEST(Blades, AreAsThickAsTheirPointsHoweverManyVertices) {
    constexpr double kThickness = 0.02;
    for (const int spacings : in_tiers<int>({3}, {6})) {
        for (const std::uint64_t seed : in_tiers<std::uint64_t>({1}, {2, 3})) {
            const Cloud cloud =
                turned(blade(kThickness, kThickness / spacings, seed), static_cast<double>(seed));
            double before = 1;
            for (const int vertices : in_tiers<int>({500}, {1000, 2000, 4000})) {
                SCOPED_TRACE(std::to_string(spacings) + ' ' + std::to_string(seed) + ' ' +
                             std::to_string(vertices));
                const NeuralMesh mesh = mesh_of(cloud, vertices, seed);
                EXPECT_NEAR(soundness::volume_of(mesh) / (0.3 * kThickness), 1, 0.01);
                EXPECT_LT(mesh.report.rms_error, std::max(1.05 * before, 0.01));
                before = mesh.report.rms_error;  // below .01 % a two hundredth of the thickness
            }
        }
    }
}

}  // namespace
}  // namespace neuralmesh
