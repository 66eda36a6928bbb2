// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Clouds of few points, and meshes of many more vertices than points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;

/// Turned, so that its edges follow no axis.
Cloud turned_by(double angle, Cloud cloud) {
    vcg::Matrix44d turn;
    turn.SetRotateRad(angle, vcg::Point3d(1, 2, 3));
    for (vcg::Point3d& p : cloud) p = turn * p;
    return cloud;
}

/// The corners of a box of 1 x 2 x 3, and \p between points on each edge.
Cloud frame_of_box(int between) {
    Cloud cloud;
    const vcg::Point3d size(1, 2, 3);
    for (int corner = 0; corner < 8; ++corner) {
        const vcg::Point3d p((corner & 1) * size[0], (corner >> 1 & 1) * size[1], (corner >> 2) * size[2]);
        cloud.push_back(p);
        for (int k = 0; k < 3; ++k)
            for (int i = 1; i <= between && (corner >> k & 1) == 0; ++i) {
                cloud.push_back(p);
                cloud.back()[k] += size[k] * i / (between + 1);
            }
    }
    return cloud;
}

/// 1 for an equilateral triangle, 0 for one without area.
double quality(const vcg::Point3d& a, const vcg::Point3d& b, const vcg::Point3d& c) {
    const double edges = (b - a).SquaredNorm() + (c - b).SquaredNorm() + (a - c).SquaredNorm();
    return edges > 0 ? 2 * std::sqrt(3.0) * ((b - a) ^ (c - a)).Norm() / edges : 0;
}

NeuralMesh expect_well_shaped(const Cloud& cloud, int vertices) {
    SCOPED_TRACE(std::to_string(cloud.size()) + " points");
    Settings settings;
    settings.target_vertices = vertices;
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(soundness::target_of(cloud), settings, progress);
    soundness::expect_exact(mesh, settings);
    EXPECT_TRUE(soundness::has_warning(mesh, "carry about"));
    std::vector<vcg::Point3d> places = mesh.positions;
    std::sort(places.begin(), places.end(), [](const auto& p, const auto& q) {
        return std::tie(p[0], p[1], p[2]) < std::tie(q[0], q[1], q[2]);
    });
    EXPECT_TRUE(std::adjacent_find(places.begin(), places.end()) == places.end()) << "coincident vertices";
    double least = 1;
    for (const auto& [a, b, c] : mesh.faces)
        least = std::min(least, quality(mesh.positions[static_cast<std::size_t>(a)],
                                        mesh.positions[static_cast<std::size_t>(b)],
                                        mesh.positions[static_cast<std::size_t>(c)]));
    EXPECT_GE(least, 0.01);
    return mesh;
}

TEST(FewPoints, OfASphereMakeWellShapedFaces) {
    for (const int count : {6, 50, 200, 255}) expect_well_shaped(shapes::sphere_cloud(count), 1000);
}

TEST(FewPoints, AreMoreThanTheVertices) {
    Settings settings;
    settings.target_vertices = 50;
    NoProgress progress;
    const NeuralMesh mesh =
        reconstruct(soundness::target_of(shapes::box_cloud(100, {1, 2, 3})), settings, progress);
    soundness::expect_exact(mesh, settings);
    EXPECT_EQ(mesh.report.boundary_loops, 0);
    EXPECT_NEAR(soundness::volume_of(mesh), 6, 0.9);
}

TEST(FewPoints, OfABoxGiveTheBox) {
    for (const int between : {0, 1, 4})
        EXPECT_NEAR(soundness::volume_of(expect_well_shaped(turned_by(0.7, frame_of_box(between)), 300)), 6,
                    0.03);
}

// The points of 64 at the base of a cone have a neighbour in common.
TEST(FewPoints, OfAConeGiveTheCone) {
    Cloud cloud = {{0, 0, 2}};
    for (int i = 0; i < 64; ++i) cloud.emplace_back(std::cos(i * M_PI / 32), std::sin(i * M_PI / 32), 0.0);
    Settings settings;
    settings.target_vertices = 500;
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(soundness::target_of(cloud), settings, progress);
    soundness::expect_exact(mesh, settings);
    EXPECT_NEAR(soundness::volume_of(mesh), 2 * M_PI / 3, 0.02);
}

}  // namespace
}  // namespace neuralmesh
