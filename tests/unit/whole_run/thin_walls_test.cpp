// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Walls thinner than the edges of the mesh are long: both of their sides are learned, and do not cross.
#include <gtest/gtest.h>

#include "tests/unit/support/crumpled.h"
#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

constexpr double kWall = 0.03;

/// The faces of \p mesh that others cut.
std::set<Triangle> cut_faces_of(const NeuralMesh& mesh) {
    shapes::Shape shape;
    for (const auto& p : mesh.positions) shape.positions.push_back(vcg::Point3d::Construct(p));
    shape.faces = mesh.faces;
    return cut_faces(referee::network_of(shape));
}

/// A box with four walls and a floor, open at the top.
shapes::Cloud open_box(int count) {
    shapes::Cloud cloud;
    Random random(3);
    const vcg::Point3d outside(1, 0.8, 0.6), inside(1 - 2 * kWall, 0.8 - 2 * kWall, 0.6);
    while (static_cast<int>(cloud.size()) < count) {
        // The surface of the outside, or that of the inside, which is open at the top.
        const bool outer = random.below(2) == 0;
        const vcg::Point3d& edges = outer ? outside : inside;
        vcg::Point3d p = shapes::in_cube(random);
        const int k = static_cast<int>(random.below(3));
        const double area = edges[(k + 1) % 3] * edges[(k + 2) % 3];
        if (static_cast<double>(random.unit()) > area / 0.8) continue;
        p[k] = p[k] < 0 ? -1 : 1;
        for (int i = 0; i < 3; ++i) p[i] *= edges[i] / 2;
        if (!outer) p[2] += kWall;
        const bool at_top = p[2] > 0.6 / 2 - 1e-9;
        const bool over_opening = std::abs(p[0]) < 0.5 - kWall && std::abs(p[1]) < 0.4 - kWall;
        if (at_top && (over_opening || !outer || k != 2)) continue;
        cloud.push_back(p);
    }
    return cloud;
}

// Without thicker walls while learning, 199 of the 2,996 faces cut others.
TEST(ThinWalls, OfAnOpenBoxDoNotCross) {
    constexpr int kPoints = 40000;  // their spacing is a third of the wall, whose thickness is half an edge
    Settings settings;
    settings.target_vertices = 1500;
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(soundness::target_of(open_box(kPoints)), settings, progress);
    soundness::expect_exact(mesh, settings);
    EXPECT_EQ(mesh.report.components, 1);
    EXPECT_EQ(mesh.report.genus, 0);
    EXPECT_EQ(mesh.report.boundary_loops, 0);
    EXPECT_TRUE(cut_faces_of(mesh).empty());
    EXPECT_LT(mesh.report.rms_error, 100 * kWall / 10);
}

}  // namespace
}  // namespace neuralmesh
