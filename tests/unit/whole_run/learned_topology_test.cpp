// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs with learn_topology.
#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::learned_topology_test {

Settings settings_of(int start_mesh) {
    Settings settings = with_target(1500, start_mesh);
    settings.learn_topology = true;
    return settings;
}

/// One sphere around both.
Shape ball(double apart) {
    Shape mesh = shapes::icosphere(2);
    for (vcg::Point3d& p : mesh.positions) p = vcg::Point3d(p[0] * 2 + apart / 2, p[1] * 1.2, p[2] * 1.2);
    return mesh;
}

TEST(LearnedTopology, PartsThatTheStartMeshJoinsComeApart) {
    Settings settings = settings_of(kTetrahedron);
    const Cloud cloud = shapes::two_sphere_cloud(20000, 3);
    const NeuralMesh apart = learn_exactly(cloud, settings);
    EXPECT_EQ(topology_of(apart), (Topology{2, 0, 0}));
    ASSERT_FALSE(apart.report.notes.empty());
    EXPECT_NE(apart.report.notes.back().find("Membranes were given up"), std::string::npos);
    settings.learn_topology = false;
    EXPECT_EQ(learn(cloud, settings).report.components, 1);
}

TEST(LearnedTopology, AGivenMeshKeepsItsTopology) {
    Settings settings = settings_of(kGivenMesh);
    EXPECT_EQ(learn(shapes::two_sphere_cloud(20000, 3), settings, ball(3)).report.components, 1);
}

TEST(LearnedTopology, FindsTheHandleOfATorusFromTheTetrahedron) {
    Settings settings = settings_of(kTetrahedron);
    const Cloud cloud = shapes::torus_cloud(60000);
    for (const int seed : {1, 2, 3}) {
        settings.random_seed = seed;
        const NeuralMesh ring = learn_exactly(cloud, settings);
        EXPECT_EQ(topology_of(ring), kRing) << seed;
    }
    settings.learn_topology = false;
    EXPECT_EQ(learn(cloud, settings).report.genus, 0);
}

/// The part of a unit sphere below z = .6.
Cloud bowl(int count) { return open_shapes::sphere_below(0.6, count); }

TEST(LearnedTopology, OpensWhereTheCloudEndsFromTheTetrahedron) {
    Settings settings = settings_of(kTetrahedron);
    const Cloud cloud = bowl(30000);
    for (const int seed : {1, 2, 3, 4}) {
        settings.random_seed = seed;
        const NeuralMesh open = learn_exactly(cloud, settings);
        EXPECT_EQ(open.report.boundary_loops, 1) << seed;
        double highest = -1, outward = 0;
        for (const vcg::Point3d& p : open.positions) highest = std::max(highest, p[2]);
        EXPECT_NEAR(highest, 0.6, 0.03) << seed;
        for (const Triangle& f : open.faces) outward += area_of(open, f) * middle_of(open, f) > 0 ? 1 : -1;
        // Some faces along the boundary may be folded.
        EXPECT_GT(outward, 0.99 * static_cast<double>(open.faces.size())) << seed;
    }
    settings.surface = kClosedSurface;
    EXPECT_EQ(learn(cloud, settings).report.boundary_loops, 0);
}

TEST(LearnedTopology, TellsOfOpenings) {
    Settings settings = settings_of(kTetrahedron);
    settings.surface = kOpenSurface;
    const NeuralMesh open = learn(bowl(30000), settings);
    ASSERT_FALSE(open.report.notes.empty());
    EXPECT_NE(open.report.notes.back().find("genus 0 with 1 boundary loop(s)."), std::string::npos);
    EXPECT_TRUE(open.report.warnings.empty());
    const NeuralMesh closed = learn(shapes::sphere_cloud(30000), settings);
    EXPECT_EQ(closed.report.boundary_loops, 0);
    ASSERT_EQ(closed.report.warnings.size(), 1U);
    EXPECT_NE(closed.report.warnings.back().find("The surface is closed"), std::string::npos);
}

// Small faces on either side of an edge have no points by chance.
TEST(LearnedTopology, SharpEdgesAreNoWebs) {
    Settings settings = settings_of(kShell);
    const Cloud cloud = shapes::box_cloud(20000, {2, 2, 2});
    const NeuralMesh with = learn(cloud, settings);
    settings.learn_topology = false;
    EXPECT_EQ(with.positions, learn(cloud, settings).positions);
}

TEST(LearnedTopology, HostileCloudsGiveSoundMeshes) {
    Cloud strip, curve;
    Random random(4);
    for (int i = 0; i < 10000; ++i) {
        const double turn = 6.283185307 * shapes::unit(random);
        const double across = 0.3 * shapes::signed_unit(random);
        const double radius = 1 + across * std::cos(turn / 2);
        strip.emplace_back(radius * std::cos(turn), radius * std::sin(turn), across * std::sin(turn / 2));
        curve.emplace_back(std::cos(turn), std::sin(turn), 0.3 * std::sin(3 * turn));
    }
    for (const Cloud& cloud : {shapes::two_sphere_cloud(10000, 2), strip, curve}) {
        Settings settings = settings_of(kTetrahedron);
        settings.surface = kClosedSurface;
        settings.target_vertices = 1000;
        const NeuralMesh mesh = learn_exactly(cloud, settings);
        EXPECT_EQ(mesh.report.boundary_loops, 0);
    }
}

}  // namespace neuralmesh::learned_topology_test
