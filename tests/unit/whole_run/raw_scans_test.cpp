// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs on what comes out of sensors: one layer, towards the sensor, smooth where the points are noisy.
#include "tests/unit/support/crumpled.h"
#include "tests/unit/support/depth_camera.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::raw_scans_test {

using vcg::Point3d;

/// Of the faces of a mesh.
struct Figures {
    double median_angle = 0;  ///< to the surface of the scene, in degrees
    double facing = 0;        ///< share of the area that faces the camera
};

Figures figures_of(const NeuralMesh& mesh, const Point3d& camera = {0, 0, 0}) {
    std::vector<double> angles;
    const auto [all, facing] = areas_of(mesh, [&](const Point3d& area, const Point3d& middle) {
        if (area.Norm() > 0) angles.push_back(sensors::angle_to_scene(middle, area / area.Norm()));
        return area * (middle - camera) < 0;
    });
    std::nth_element(angles.begin(), angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2),
                     angles.end());
    return {angles[angles.size() / 2], facing / all};
}

TEST(RawScans, ADepthFrameIsOneLayerThatFacesTheCamera) {
    double least = 90;
    for (const int vertices : {1500, 3000, 6000}) {
        const NeuralMesh mesh = learn_exactly(sensors::depth_frame(200), with_target(vertices));
        EXPECT_LE(mesh.report.genus, 1) << vertices;
        EXPECT_GE(mesh.report.boundary_loops, 1) << vertices;
        EXPECT_TRUE(cut_faces(network_of({mesh.positions, mesh.faces})).empty()) << vertices;
        const Figures figures = figures_of(mesh);
        EXPECT_GT(figures.facing, 0.9) << vertices;
        // More vertices do not follow the noise, whose slopes between neighbouring points are 60 degrees.
        EXPECT_LT(figures.median_angle, std::max(4.0, 1.2 * least)) << vertices;
        least = std::min(least, figures.median_angle);
    }
}

TEST(RawScans, AFrameFacesItsCameraInTheCoordinatesOfARoom) {
    // Above or below the camera, and the origin between camera and wall: neither tells the side.
    for (const Point3d& camera : {Point3d(10, 40, 5), Point3d(0.2, 0.3, -2)}) {
        Cloud cloud = sensors::depth_frame(200);
        for (Point3d& p : cloud) p += camera;
        EXPECT_GT(figures_of(learn_exactly(cloud, with_target(1500)), camera).facing, 0.9) << camera[2];
    }
}

TEST(RawScans, TheStepsOfDepthsAreNoSurface) {
    for (const int vertices : {1500, 6000}) {
        const NeuralMesh mesh = learn_exactly(sensors::frame_of_steps(240), with_target(vertices));
        EXPECT_EQ(topology_of(mesh), kDisc) << vertices;
        const auto [all, steep] = areas_of(mesh, [](const Point3d& area, const auto&) {
            return std::abs(area * sensors::kNormalOfSteps) < 0.95 * area.Norm();  // 18 degrees
        });
        EXPECT_LT(steep / all, 0.02) << vertices;
    }
}

TEST(RawScans, TreesAreLeftOutAndTheGroundIsOneSheet) {
    const Cloud cloud = sensors::aerial_scan(40000, 30);
    const NeuralMesh mesh = learn_exactly(cloud, with_target(3000));
    EXPECT_EQ(mesh.report.genus, 0);
    EXPECT_TRUE(has_warning(mesh, "show no surface"));
    int above = 0, down = 0;
    for (const Triangle& f : mesh.faces) down += area_of(mesh, f)[2] < 0 ? 1 : 0;
    for (const Point3d& p : mesh.positions)
        above += p[2] - std::sin(p[0] / 6) - std::cos(p[1] / 5) > sensors::kTree / 3 ? 1 : 0;
    EXPECT_LT(down, static_cast<int>(mesh.faces.size()) / 50);
    EXPECT_LT(above, 30) << "vertices in the crowns";
}

TEST(RawScans, PointsAtSeveralHeightsDoNotFoldASheet) {
    // A wood beside a meadow: its points fill the height of some spacings under a wavy top.
    constexpr double kHeight = 4, kSize = 100;
    Random random(1);
    Cloud cloud;
    for (int i = 0; i < 30000; ++i) {
        const double x = kSize * shapes::unit(random), y = kSize * shapes::unit(random);
        const double height = static_cast<double>(2 * random.unit() - 1);
        const bool wood = x > kSize / 2;
        cloud.emplace_back(x, y,
                           wood ? kHeight * (std::sin(1.3 * x) * std::sin(1.1 * y) + height) : 0.02 * height);
    }
    EXPECT_GT(figures_of(learn_exactly(cloud, with_target(3000)), {0, 0, 1e6}).facing, 0.99);
}

TEST(RawScans, OnePlaneAndCrossingPlanesAreOpen) {
    Cloud crossing = shapes::plane_cloud(20000, 1);
    for (const Point3d& p : shapes::plane_cloud(20000, 2)) crossing.emplace_back(p[0], 0, p[1]);
    EXPECT_GE(learn_exactly(crossing, with_target(1000)).report.boundary_loops, 1);
    EXPECT_EQ(learn_exactly(shapes::plane_cloud(20000), with_target(1000)).report.boundary_loops, 1);
}

TEST(RawScans, LinesDenserAlongThanAcrossAreOneSheet) {
    for (const int density : {10, 30}) {
        constexpr int kLines = 50;
        Random random(1);
        Cloud cloud;
        for (int i = 0; i < kLines * kLines * density; ++i) {
            const double x = shapes::unit(random), y = static_cast<double>(i % kLines) / kLines;
            cloud.emplace_back(x, y, 0.3 * x * (1 - x) * (1 + y));
        }
        const NeuralMesh mesh = learn_exactly(cloud, with_target(1000));
        EXPECT_EQ(topology_of(mesh), kDisc) << density;
    }
}

TEST(RawScans, APointAtTheSensorIsNotLearned) {
    Cloud cloud = sensors::depth_frame(160);
    cloud.emplace_back(0, 0, 0);
    for (const Point3d& p : learn_exactly(cloud, with_target(1500)).positions) EXPECT_GT(p[2], 0.5);
}

}  // namespace neuralmesh::raw_scans_test
