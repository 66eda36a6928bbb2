// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs on open, noisy and thin clouds: the finished mesh keeps the components and genus of the shell.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/unit/support/shell_shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using soundness::has_warning;

NeuralMesh finished(const std::vector<vcg::Point3d>& cloud, int vertices, int surface = kAutomatic) {
    Settings settings;
    settings.target_vertices = vertices;
    settings.surface = surface;
    NoProgress progress;
    return reconstruct(soundness::target_of(cloud), settings, progress);
}

void expect_closed(const NeuralMesh& mesh, int vertices, int components, int genus) {
    EXPECT_EQ(mesh.report.vertices, vertices);
    EXPECT_EQ(mesh.report.components, components);
    EXPECT_EQ(mesh.report.genus, genus);
    EXPECT_EQ(mesh.report.boundary_loops, 0);
    std::vector<vcg::Point3f> positions;
    for (const vcg::Point3d& p : mesh.positions) positions.push_back(vcg::Point3f::Construct(p));
    EXPECT_EQ(Network(positions, mesh.faces).validate(), "");
}

/// Points of a sphere; every hundredth is replaced by a random point in a box three times as wide.
std::vector<vcg::Point3d> sphere_with_gross_outliers() {
    Random random(11);
    std::vector<vcg::Point3d> cloud = shell_shapes::sample(shell_shapes::sphere(1), 20000, random);
    const auto anywhere = [&] { return 6 * static_cast<double>(random.unit()) - 3; };
    for (std::size_t i = 0; i < cloud.size(); i += 100) cloud[i] = {anywhere(), anywhere(), anywhere()};
    return cloud;
}

/// All vertices are near the unit sphere.
void expect_sphere(const NeuralMesh& mesh, double within) {
    for (const vcg::Point3d& p : mesh.positions) ASSERT_NEAR(p.Norm(), 1, within);
}

TEST(ShellFinished, GrossOutliersMakeNoComponentsAndDoNotPull) {
    for (const int vertices : {500, 2000}) {
        const NeuralMesh mesh = finished(sphere_with_gross_outliers(), vertices);
        expect_closed(mesh, vertices, 1, 0);
        expect_sphere(mesh, 0.05);
        EXPECT_TRUE(has_warning(mesh, "as outliers"));
        EXPECT_GE(mesh.report.outliers, 180);
        EXPECT_LE(mesh.report.outliers, 220);
    }
}

TEST(ShellFinished, OnePointFarAwayCostsNeitherTimeNorPrecision) {
    Random random(20);
    std::vector<vcg::Point3d> cloud = shell_shapes::sample(shell_shapes::sphere(1), 20000, random);
    cloud.emplace_back(2e5, 0, 0);
    const NeuralMesh mesh = finished(cloud, 500);
    expect_closed(mesh, 500, 1, 0);
    expect_sphere(mesh, 0.01);
    EXPECT_LT(mesh.report.rms_error, 0.5);
    EXPECT_GT(mesh.report.rms_error, 0.01) << "must be relative to the sphere's box, without the far point";
}

TEST(ShellFinished, PointsDeepInsideDoNotPull) {
    Random random(17);
    std::vector<vcg::Point3d> cloud = shell_shapes::sample(shell_shapes::sphere(1), 20000, random);
    for (std::size_t i = 0; i < 200; ++i) cloud[i] *= 0.1 + 0.6 * static_cast<double>(random.unit());
    const NeuralMesh mesh = finished(cloud, 500);
    expect_closed(mesh, 500, 1, 0);
    expect_sphere(mesh, 0.02);
    EXPECT_TRUE(has_warning(mesh, "of 20000 points (1.0 %) were left out as outliers"));
}

TEST(ShellFinished, AHalfAThousandTimesSparserIsNoOutlier) {
    Random random(18);
    std::vector<vcg::Point3d> cloud = shell_shapes::sample(shell_shapes::sphere(1), 400000, random);
    std::size_t below = 0;
    shell_shapes::cut_off(cloud, [&](const vcg::Point3d& p) { return p[2] < 0 && ++below % 1000 != 0; });
    const NeuralMesh mesh = finished(cloud, 500);
    expect_closed(mesh, 500, 1, 0);
    EXPECT_LT(mesh.report.outliers, 30) << "of the 200 sparse points";
}

TEST(ShellFinished, RepeatedPointsAreLearnedOnce) {
    Random random(19);
    std::vector<vcg::Point3d> cloud = shell_shapes::sample(shell_shapes::sphere(1), 60, random);
    for (int doubling = 0; doubling < 7; ++doubling) cloud.insert(cloud.end(), cloud.begin(), cloud.end());
    const NeuralMesh mesh = finished(cloud, 250);
    expect_closed(mesh, 250, 1, 0);
    EXPECT_TRUE(has_warning(mesh, "7620 of 7680 points repeat others"));
}

TEST(ShellFinished, EveryPointIsLearnedIfOutliersAreNotRemoved) {
    Settings settings;
    settings.target_vertices = 500;
    settings.remove_outliers = false;
    NoProgress progress;
    const NeuralMesh mesh =
        reconstruct(soundness::target_of(sphere_with_gross_outliers()), settings, progress);
    EXPECT_EQ(mesh.report.outliers, 0);
    EXPECT_TRUE(has_warning(mesh, "points were ignored as outliers by the start mesh, but are learned"));
    double farthest = 0;
    for (const vcg::Point3d& p : mesh.positions) farthest = std::max(farthest, p.Norm());
    EXPECT_GT(farthest, 1.5) << "outliers pull at the mesh";
}

TEST(ShellFinished, FarClumpsOfFewPointsMakeNoComponents) {
    Random random(12);
    std::vector<vcg::Point3d> cloud = shell_shapes::sample(shell_shapes::torus(1, 0.35), 20000, random);
    for (const double x : {3.0, -3.0, 5.0})
        for (int i = 0; i < 150; ++i)
            cloud.emplace_back(x + 0.05 * static_cast<double>(random.unit()),
                               0.05 * static_cast<double>(random.unit()), 2);
    const NeuralMesh mesh = finished(cloud, 500);
    expect_closed(mesh, 500, 1, 1);
    EXPECT_TRUE(has_warning(mesh, "450 of 20450 points were ignored as outliers"));
}

TEST(ShellFinished, ANarrowHoleOfANoisySphereIsClosedWithAWarning) {
    std::vector<vcg::Point3d> cloud = shapes::sphere_cloud(50000, 0.04);
    shell_shapes::cut_off(cloud, [](const vcg::Point3d& p) { return p[2] > 0.96; });
    const NeuralMesh mesh = finished(cloud, 500, kAutomatic);
    expect_closed(mesh, 500, 1, 0);
    EXPECT_TRUE(has_warning(mesh, "were closed. Choose surface 2 (open) to keep"));
}

TEST(ShellFinished, ACloudTooSparseForItsShellTakesACoarserOneAndSaysSo) {
    // Clusters of points, far apart: dense enough for a fine lattice, on which they stay apart.
    Random random(16);
    std::vector<vcg::Point3d> cloud;
    const auto jitter = [&] { return 0.004 * static_cast<double>(random.unit()); };
    for (const vcg::Point3d& p : shell_shapes::sample(shell_shapes::torus(1, 0.15), 800, random))
        for (int i = 0; i < 30; ++i) cloud.push_back(p + vcg::Point3d(jitter(), jitter(), jitter()));
    const NeuralMesh mesh = finished(cloud, 200, kClosedSurface);
    expect_closed(mesh, 200, 1, 1);
    EXPECT_TRUE(has_warning(mesh, "A coarser one was made"));
}

}  // namespace
}  // namespace neuralmesh
