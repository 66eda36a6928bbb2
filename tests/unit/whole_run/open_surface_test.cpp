// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs on surfaces with boundary, and the choice between open and closed.
#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"
#include "tests/unit/support/shell_shapes.h"
#include "vcg_core/mesh/boundary_loops.h"
#include "vcg_core/start/open_start.h"

namespace neuralmesh::open_surface_test {

using open_shapes::Case;

Settings settings_with(int vertices, int surface) {
    Settings settings = with_target(vertices);
    settings.surface = surface;
    settings.settling_signals_per_vertex = 5;
    return settings;
}

TEST(OpenSurface, ComesOutWithItsTopologyAndExactlyAsManyVertices) {
    bool chosen = false;  // by the filter, because the cloud encloses no space, or by the user
    for (const Case& each : open_shapes::cases())
        for (const int vertices : {300, 1500}) {
            chosen = !chosen;
            SCOPED_TRACE(each.name + ", " + std::to_string(vertices));
            const Settings settings = settings_with(vertices, chosen ? kAutomatic : kOpenSurface);
            const NeuralMesh mesh = learn_exactly(each.cloud, settings);
            EXPECT_EQ(topology_of(mesh), (Topology{each.components, each.genus, each.loops}));
            EXPECT_LT(mesh.report.rms_error, 0.7);
            EXPECT_EQ(has_warning(mesh, "the surface ends where they end"), chosen);
        }
}

// The origin lies in the square, above it and below it.
TEST(OpenSurface, FacesTheOriginIfThatIsBesideItElseUp) {
    for (const double height : {0.0, -3.0, 3.0}) {
        Cloud cloud = shapes::plane_cloud(8000);
        Random random(2);
        for (vcg::Point3d& p : cloud) p[2] = height + 0.002 * shapes::signed_unit(random);
        const NeuralMesh mesh = learn(cloud, settings_with(500, kOpenSurface));
        const auto [all, up] =
            areas_of(mesh, [](const vcg::Point3d& area, const auto&) { return area[2] > 0; });
        EXPECT_NEAR(up / all, height > 0 ? 0 : 1, 0.01) << height;
    }
}

TEST(OpenSurface, IsTheStartOfWallsWithGapsAsWideAsTheyAreThick) {
    const Cloud cloud = open_shapes::tube_with_gap(66000);
    const NeuralMesh mesh = learn(cloud, settings_with(1500, kAutomatic));
    EXPECT_EQ(topology_of(mesh), kRing);
    EXPECT_LT(mesh.report.rms_error, 0.1);
    EXPECT_FALSE(has_warning(mesh, "enclose no space"));
}

TEST(OpenSurface, IsClosedWhereBothWallsArePoints) {
    // Both walls of a cup, too close to each other for a space between them that the shell finds.
    Random random(1);
    const Cloud cloud = shell_shapes::sample(shell_shapes::cup(1, 2, 0.06), 100000, random);
    const NeuralMesh mesh = learn(cloud, settings_with(800, kAutomatic));
    EXPECT_EQ(topology_of(mesh), kBall);
    EXPECT_FALSE(has_warning(mesh, "the surface ends where they end"));
}

TEST(OpenSurface, IsNotChosenWhereBothSidesOfAWallLookLikeOneSheet) {
    // The wall is as thick as one to two spacings of the points: an open surface would run between its sides.
    for (const int count : {3000, 10000}) {
        Random random(1);
        const Cloud cloud = shell_shapes::sample(shell_shapes::cup(1, 2, 0.06), count, random);
        const NeuralMesh mesh = learn(cloud, settings_with(400, kAutomatic));
        EXPECT_EQ(mesh.report.boundary_loops, 0) << count;
        EXPECT_TRUE(has_warning(mesh, "the two sides of walls about 0.06")) << count;
        EXPECT_TRUE(has_warning(mesh, "cannot be told apart")) << count;
    }
}

TEST(OpenSurface, OfAThinWallIsOneSheetAndSaysSo) {
    // Two squares, 1.5 spacings apart.
    Cloud wall = shapes::plane_cloud(10000, 1);
    for (const vcg::Point3d& p : shapes::plane_cloud(10000, 2))
        wall.push_back(p * 10 + vcg::Point3d(0, 0, 0.15));
    for (std::size_t i = 0; i < 10000; ++i) wall[i] *= 10;
    const NeuralMesh mesh = learn(wall, settings_with(400, kOpenSurface));
    EXPECT_EQ(mesh.report.boundary_loops, 1);
    EXPECT_TRUE(has_warning(mesh, "walls about 0.15 thick"));
    EXPECT_TRUE(has_warning(mesh, "one sheet."));
    const NeuralMesh sheet = learn(shapes::plane_cloud(10000), settings_with(400, kOpenSurface));
    EXPECT_FALSE(has_warning(sheet, "walls"));
}

TEST(OpenSurface, MeasuresHolesAgainstTheMeshNotAgainstFarOutliers) {
    Cloud cloud = open_shapes::sphere_below(0.5, 20000);
    for (int i = 0; i < 30; ++i) cloud.emplace_back(40 + 0.01 * i, 40 + 0.01 * (i % 7), 40 + 0.01 * (i % 3));
    EXPECT_EQ(learn(cloud, settings_with(400, kAutomatic)).report.boundary_loops, 1);
}

TEST(OpenSurface, IsNotChosenForClosedClouds) {
    const Cloud cloud = shapes::torus_cloud(5000);
    const NeuralMesh automatic = learn(cloud, settings_with(400, kAutomatic));
    const NeuralMesh closed = learn(cloud, settings_with(400, kClosedSurface));
    EXPECT_EQ(automatic.report.boundary_loops, 0);
    EXPECT_TRUE(automatic.positions == closed.positions);
    EXPECT_EQ(automatic.faces, closed.faces);
}

// Sparse points leave gaps that look like openings.
TEST(OpenSurface, IsNotChosenForClosedCloudsOfFewPoints) {
    const std::array counts = {500, 1000, 3000};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const int count = counts[i];
        SCOPED_TRACE(count);
        const std::array clouds = {shapes::sphere_cloud(count), shapes::torus_cloud(count),
                                   shapes::box_cloud(count)};
        EXPECT_EQ(learn(clouds[i], settings_with(200, kAutomatic)).report.boundary_loops, 0);
        const Cloud half = open_shapes::sphere_below(0, 2 * count);
        EXPECT_EQ(learn(half, settings_with(200, kAutomatic)).report.boundary_loops, 1);
    }
}

double boundary_length(const NeuralMesh& mesh) {
    double length = 0;
    const auto at = [&](VertexId v) { return mesh.positions[static_cast<std::size_t>(v)]; };
    for (const auto& loop : boundary_loops(static_cast<int>(mesh.positions.size()), mesh.faces))
        for (std::size_t i = 0; i < loop.size(); ++i)
            length += (at(loop[i]) - at(loop[(i + 1) % loop.size()])).Norm();
    return length;
}

// A start mesh too coarse for the boundary folds there.
TEST(OpenSurface, OfFewVerticesHasABoundaryAsLongAsThatOfTheCloud) {
    const double radius = 0.7;  // of the ball that is cut out of the tube of a torus
    const Cloud cloud = open_shapes::cut(shapes::torus_cloud(100000), [&](const vcg::Point3d& p) {
        return (p - vcg::Point3d(1, 0, 0.25)).Norm() > radius;
    });
    const NeuralMesh fine = learn(cloud, settings_with(5000, kAutomatic));
    const NeuralMesh coarse = learn(cloud, settings_with(300, kAutomatic));
    EXPECT_EQ(topology_of(coarse), topology_of(fine));
    EXPECT_NEAR(boundary_length(coarse) / boundary_length(fine), 1, 0.1);
}

TEST(OpenSurface, OfALayerWithFacesEndsWhereTheyEnd) {
    const NeuralMesh mesh = learn_exactly(target_of(shapes::grid(9, 9)), settings_with(300, kAutomatic));
    EXPECT_EQ(mesh.report.boundary_loops, 1);
}

/// Of what is learned from a sphere of faces without those above \p height.
int loops_of_faces_below(double height, double close_holes_up_to) {
    const Shape cap =
        open_shapes::cut(shapes::icosphere(4), [&](const vcg::Point3d& p) { return p[2] <= height; });
    Settings settings = settings_with(300, kAutomatic);
    settings.close_holes_up_to = close_holes_up_to;
    return learn(target_of(cap), settings).report.boundary_loops;
}

TEST(OpenSurface, OfALayerWithFacesIsDecidedByTheirLoops) {
    EXPECT_EQ(loops_of_faces_below(2, 0), 0);
    EXPECT_EQ(loops_of_faces_below(0.8, -1), 1);  // 1.2 wide, a third of the diagonal
    EXPECT_EQ(loops_of_faces_below(0.97, 1), 0);  // .5 wide
    EXPECT_EQ(loops_of_faces_below(2, -1), 0);
    EXPECT_EQ(loops_of_faces_below(0.8, 2), 0);
    EXPECT_EQ(loops_of_faces_below(0.97, 0), 1);
}

TEST(OpenSurface, IsAnErrorWhereThereIsNone) {
    for (const int surface : {kAutomatic, kOpenSurface})
        EXPECT_THROW(learn(open_shapes::helix(2000), settings_with(300, surface)), NoSurfaceError);
    EXPECT_EQ(learn(open_shapes::helix(2000), settings_with(300, kClosedSurface)).report.boundary_loops, 0);
    EXPECT_THROW(learn(shapes::plane_cloud(50), settings_with(300, kOpenSurface)), InputError);
    // Too few points to show where a surface ends are closed if the filter may choose.
    EXPECT_EQ(learn(shapes::plane_cloud(50), settings_with(300, kAutomatic)).report.boundary_loops, 0);
}

TEST(OpenSurface, NeedsVerticesForItsTopology) {
    const Case holed = open_shapes::cases()[6];
    EXPECT_THROW(learn(holed.cloud, settings_with(8, kOpenSurface)), SettingError);
}

/// Two square sheets, one above the other, joined by \p side x \p side tubes.
Cloud joined_sheets(int side, int points) {
    constexpr double kApart = 0.8, kHeight = 0.6, kTube = 0.2;
    const double half = side * kApart / 2;
    Random random(1);
    Cloud cloud;
    while (static_cast<int>(cloud.size()) < points) {
        const vcg::Point3d p(half * shapes::signed_unit(random), half * shapes::signed_unit(random), 0);
        vcg::Point3d from_tube(0, 0, 0);  // to the axis of the nearest one
        for (int k = 0; k < 2; ++k)
            from_tube[k] = p[k] - ((std::floor((p[k] + half) / kApart) + 0.5) * kApart - half);
        const bool above = shapes::signed_unit(random) > 0;
        if (from_tube.Norm() > kTube) {
            cloud.push_back(p + vcg::Point3d(0, 0, above ? kHeight : 0));
        } else {  // a disc has a third of the area of its tube
            for (int i = 0; i < 3; ++i) {
                const double height = kHeight * (shapes::signed_unit(random) + 1) / 2;
                const vcg::Point3d axis = p - from_tube, way = shapes::in_ball(random);
                cloud.push_back(axis + vcg::Point3d(way[0], way[1], 0).Normalize() * kTube +
                                vcg::Point3d(0, 0, height));
            }
        }
    }
    return cloud;
}

TEST(OpenSurface, OfFewVerticesMayHaveManyHandles) {
    const NeuralMesh mesh = learn_exactly(joined_sheets(4, 60000), settings_with(500, kAutomatic));
    EXPECT_EQ(topology_of(mesh), (Topology{1, 15, 2}));
}

TEST(OpenSurface, ComesDownToTheVerticesThatItsTopologyNeeds) {
    // Five by four bent squares apart from each other. The start mesh has more vertices than asked for.
    Cloud cloud;
    for (int i = 0; i < 20; ++i)
        for (const vcg::Point3d& p : shapes::plane_cloud(300))
            cloud.push_back(p + vcg::Point3d(3.0 * (i % 5), 3.0 * (i / 5), 0.2 * p[0] * p[1]));
    for (const int vertices : {300, 120, 80, 70, 60}) {
        SCOPED_TRACE(vertices);
        const NeuralMesh mesh = learn_exactly(cloud, settings_with(vertices, kOpenSurface));
        EXPECT_EQ(topology_of(mesh), (Topology{20, 0, 20}));
    }
}

TEST(OpenSurface, CannotStartFromATetrahedron) {
    Settings settings = settings_with(200, kOpenSurface);
    settings.start_mesh = kTetrahedron;
    settings.learn_topology = false;
    const NeuralMesh mesh = learn(shapes::sphere_cloud(2000), settings);
    EXPECT_EQ(mesh.report.boundary_loops, 0);
    EXPECT_TRUE(has_warning(mesh, "because start_mesh 1 (tetrahedron) is"));
}

}  // namespace neuralmesh::open_surface_test
