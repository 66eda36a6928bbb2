// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Learning from a sampler of the caller's: an implicit surface, of which nothing but its function is known.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

/// Zero on a torus of radii 1 and .4 around the z axis; elsewhere the distance from it.
double distance(const vcg::Point3d& p) {
    const double rim = std::sqrt(p[0] * p[0] + p[1] * p[1]) - 1;
    return std::sqrt(rim * rim + p[2] * p[2]) - 0.4;
}

/// Central differences.
vcg::Point3d gradient(const vcg::Point3d& p) {
    constexpr double kStep = 1e-6;
    vcg::Point3d result;
    for (int k = 0; k < 3; ++k) {
        vcg::Point3d ahead = p, behind = p;
        ahead[k] += kStep;
        behind[k] -= kStep;
        result[k] = (distance(ahead) - distance(behind)) / (2 * kStep);
    }
    return result;
}

/// A random point of a thin layer around the surface, moved onto it.
vcg::Point3d on_torus(Random& random) {
    for (;;) {
        vcg::Point3d p = shapes::in_cube(random);
        p = vcg::Point3d(1.5 * p[0], 1.5 * p[1], 0.5 * p[2]);
        if (std::abs(distance(p)) < 0.1) return p - gradient(p) * distance(p);
    }
}

TEST(Sampler, LearnsAnImplicitSurface) {
    Settings settings;
    settings.target_vertices = 1500;
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(TargetSpace::drawn_by(on_torus, 30000), settings, progress);
    soundness::expect_exact(mesh, settings);
    EXPECT_EQ(mesh.report.genus, 1);
    EXPECT_EQ(mesh.report.boundary_loops, 0);
    EXPECT_EQ(mesh.report.outliers, 0);
    for (const vcg::Point3d& p : mesh.positions) EXPECT_LT(std::abs(distance(p)), 0.01);
}

/// Signals are not repeated: far more distinct ones than the points drawn first.
TEST(Sampler, DrawsANewPointForEverySignal) {
    const TargetSpace target = TargetSpace::drawn_by(on_torus, 100);
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const vcg::Point3f p = target.sample(random);
        EXPECT_EQ(std::count(target.positions().begin(), target.positions().end(), p), 0);
        EXPECT_LT(std::abs(distance(target.frame().outside(p))), 1e-4);
    }
}

}  // namespace
}  // namespace neuralmesh
