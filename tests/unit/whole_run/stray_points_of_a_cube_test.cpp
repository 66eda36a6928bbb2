// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Stray points beside a cube: a whole run brings no vertex to them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;

// Where surfaces are flat the bending term is weak, and single points draw vertices to themselves.
TEST(StrayPoints, DrawNoVertexOfACube) {
    Cloud cloud = shapes::box_cloud(20000);
    Random random(4);
    for (std::size_t i = 0; i < 400; ++i) cloud[i] += shapes::in_ball(random) * 0.3;
    const TargetSpace target = soundness::target_of(cloud);
    Settings settings;
    settings.target_vertices = 1500;
    settings.threads = 1;
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(target, settings, progress);
    soundness::expect_exact(mesh, settings);
    double sum = 0;
    for (const vcg::Point3d& p : mesh.positions) {
        const double off = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) - 0.5;
        sum += off * off;
    }
    const double rms = std::sqrt(sum / static_cast<double>(mesh.positions.size()));
    EXPECT_LT(rms, 0.003) << "twice as much without this rule";
    settings.threads = 2;
    EXPECT_EQ(reconstruct(target, settings, progress).positions, mesh.positions);
}

}  // namespace
}  // namespace neuralmesh
