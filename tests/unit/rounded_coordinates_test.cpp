// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Clouds far from the origin, which single precision rounds, and clouds on grids, which it does not.
#include "vcg_core/rounded_coordinates.h"

#include "tests/unit/support/layer_mesh.h"
#include "tests/unit/support/runs.h"
#include "vcg_core/learning_task.h"
#include "vcg_core/mesh_io.h"

namespace neuralmesh::rounded_coordinates_test {

/// A layer in single precision with the cloud at \p offset, and a matrix.
TargetSpace target_at(const Cloud& cloud, const vcg::Point3d& offset,
                      const vcg::Matrix44d& matrix = vcg::Matrix44d::Identity()) {
    Shape shape;
    for (const vcg::Point3d& p : cloud) shape.positions.push_back(p + offset);
    layer_mesh::Mesh mesh;
    layer_mesh::fill(mesh, shape, false);
    return target_space_of(mesh, matrix, Settings());
}

vcg::Matrix44d turned(double angle, double scale = 1) {
    vcg::Matrix44d turn, size;
    turn.SetRotateRad(angle, vcg::Point3d(1, 2, 3));
    size.SetScale(scale, scale, scale);
    return turn * size;
}

/// The step of single precision at \p magnitude.
double step_at(double magnitude) { return std::ldexp(1.0, std::ilogb(magnitude) - 23); }

bool warns(const TargetSpace& target) {
    const std::string warning = warning_of_rounding(target);
    EXPECT_TRUE(warning.empty() || warning.back() == '.');
    return !warning.empty();
}

/// A flat box, so that all directions and edges occur.
Cloud box(int count, double spacing, double angle) {
    const double edge = std::sqrt(count / 4.0) * spacing;  // of an area of 4
    Cloud cloud = shapes::box_cloud(count, vcg::Point3d(edge, edge, edge / 2));
    const vcg::Matrix44d turn = turned(angle);
    for (vcg::Point3d& p : cloud) p = turn * p;
    return cloud;
}

using Place = std::tuple<double, int, int, double>;

/// Magnitude, which axes are far (bits), number of points, orientation.
class Rounded : public testing::TestWithParam<Place> {};

INSTANTIATE_TEST_SUITE_P(Places, Rounded,
                         testing::Combine(testing::Values(1e5, -1e6, 1e7, 1e8),
                                          testing::Values(1, 2, 3, 5, 7), testing::Values(500, 8000),
                                          testing::Values(0.0, 0.4, 1.1)));

TEST_P(Rounded, IsToldIfTheStepsAreLongBesideTheSpacing) {
    const auto& [magnitude, axes, count, angle] = GetParam();
    const double step = step_at(magnitude);
    vcg::Point3d offset;
    for (int k = 0; k < 3; ++k) offset[k] = (axes >> k & 1) != 0 ? magnitude : 0;
    for (const double steps : {0.7, 1.0, 3.0})
        EXPECT_TRUE(warns(target_at(box(count, step / steps, angle), offset))) << steps;
    for (const double steps : {0.01, 0.1, 0.2})
        EXPECT_FALSE(warns(target_at(box(count, step / steps, angle), offset))) << steps;
    EXPECT_FALSE(warns(target_at(box(count, step, angle), {0, 0, 0})));
}

TEST_P(Rounded, IsNoGridOfVoxelsOrPixels) {
    const auto& [magnitude, axes, count, angle] = GetParam();
    const double unit = 4 * step_at(magnitude);
    vcg::Point3d offset;
    for (int k = 0; k < 3; ++k) offset[k] = (axes >> k & 1) != 0 ? magnitude : 0;
    const int side = static_cast<int>(std::sqrt(count));
    Cloud voxels, pixels;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const double height = side / 4.0 * std::sin(6.0 * i / side + angle) * std::cos(4.0 * j / side);
            voxels.emplace_back(i * unit, j * unit, std::floor(height) * unit);
            pixels.emplace_back(i * unit, j * unit, height * unit);
        }
    for (const Cloud& cloud : {voxels, pixels})
        for (const double units : {1.0, 8.0}) {
            Cloud larger = cloud;
            for (vcg::Point3d& p : larger) p *= units;
            EXPECT_FALSE(warns(target_at(larger, offset))) << units;
        }
}

TEST(RoundedCoordinates, AreNotThoseOfWholeNumbersNearTheOrigin) {
    Cloud voxels;  // of a computed tomography: the surface of a ball
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j)
            for (int k = -20; k <= 20; ++k)
                if (std::abs(std::sqrt(i * i + j * j + k * k) - 18) < 0.5) voxels.emplace_back(i, j, k);
    EXPECT_FALSE(warns(target_at(voxels, {0, 0, 0})));
    EXPECT_FALSE(warns(target_at(voxels, {512, 512, 100})));
}

TEST(RoundedCoordinates, AreNotRepeatsNorAConstantCoordinate) {
    Cloud twice = shapes::sphere_cloud(2000), plane = shapes::plane_cloud(2000);
    twice.insert(twice.end(), twice.begin(), twice.end());
    twice.insert(twice.end(), twice.begin(), twice.end());
    EXPECT_FALSE(warns(target_at(twice, {1, 2, 3})));
    EXPECT_FALSE(warns(target_at(plane, {0, 0, 1e7})));
}

// A layer that has its offset in its matrix was not rounded.
TEST(RoundedCoordinates, AreThoseOfTheLayerNotOfTheWorld) {
    vcg::Matrix44d moved;
    moved.SetTranslate(1e7, 1e7, 1e7);
    const Cloud cloud = box(2000, 1, 0.4);
    EXPECT_FALSE(warns(target_at(cloud, {0, 0, 0}, moved)));
    EXPECT_TRUE(warns(target_at(cloud, {1e7, 1e7, 1e7})));
    const std::string larger = warning_of_rounding(target_at(cloud, {1e7, 1e7, 1e7}, turned(0.7, 1000)));
    EXPECT_NE(larger.find("steps of 1000,"), std::string::npos) << larger;
}

TEST(RoundedCoordinates, AreToldOnceWithTheStepAndWhatToDo) {
    const TargetSpace target = target_at(box(5000, 0.4, 0.4), {1e7, 1e7, 1e7});
    const NeuralMesh mesh = learn(target, with_target(300));
    int told = 0;
    for (const std::string& warning : mesh.report.warnings) {
        told += warning.find("Single precision has rounded the coordinates to steps of 1,") == 0 ? 1 : 0;
        EXPECT_EQ(warning.find("repeat others"), std::string::npos) << warning;
    }
    EXPECT_EQ(told, 1);
}

TEST(RoundedCoordinates, AreRefusedIfTheMeshWouldShowTheStepsOnly) {
    const TargetSpace target = target_at(box(5000, 0.1, 0.4), {1e7, 1e7, 1e7});
    Settings settings = with_target(2000);
    const std::string sentence = complaint_of([&] { learn(target, settings); });
    for (const char* words : {"steps of 1,", "Subtract an offset", "double precision", "no more than"})
        EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
    settings.target_vertices = 40;
    EXPECT_EQ(learn(target, settings).report.vertices, 40);
}

}  // namespace neuralmesh::rounded_coordinates_test
