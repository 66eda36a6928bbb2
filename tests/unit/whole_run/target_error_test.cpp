// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Meshes that have as many vertices as an error asks for.
#include "tests/unit/support/runs.h"
#include "vcg_core/learn_to_error.h"

namespace neuralmesh::target_error_test {

Settings settings_for(double error, int most = 10000) {
    Settings settings = with_target(most);
    settings.target_error = error;
    return settings;
}

/// Root mean square of the distances of points spread over the faces, all alike, to the sphere of radius 1.
double error_of_sphere(const NeuralMesh& mesh) {
    constexpr int kPerEdge = 8;
    double sum = 0;
    int count = 0;
    for (const Triangle& f : mesh.faces) {
        const auto at = [&](std::size_t k) { return corner(mesh, f, k); };
        for (int i = 0; i < kPerEdge; ++i)
            for (int j = 0; i + j < kPerEdge; ++j, ++count) {
                const double u = (i + 1.0 / 3) / kPerEdge, v = (j + 1.0 / 3) / kPerEdge;
                const double off = (at(0) * u + at(1) * v + at(2) * (1 - u - v)).Norm() - 1;
                sum += off * off;
            }
    }
    return std::sqrt(sum / count);
}

TEST(TargetError, IsReachedWithNoise) {
    constexpr double kNoise = 0.01, kError = 0.01;
    const NeuralMesh mesh = learn(target_of(shapes::sphere_cloud(20000, kNoise)), settings_for(kError));
    EXPECT_LE(mesh.report.held_out_error, 1.03 * kError);
    EXPECT_GE(mesh.report.held_out_error, 0.8 * kError);
    EXPECT_LE(error_of_sphere(mesh), 1.15 * kError);
    EXPECT_GE(error_of_sphere(mesh), 0.8 * kError);
    EXPECT_LT(mesh.report.vertices, 2000);
    EXPECT_EQ(mesh.report.vertices, static_cast<int>(mesh.positions.size()));
    EXPECT_TRUE(has_note(mesh, "as target_error asks for"));
}

TEST(TargetError, IsThatOfFacesToo) {
    const NeuralMesh mesh = learn(target_of(shapes::icosphere(4)), settings_for(0.01, 300));
    EXPECT_LE(mesh.report.held_out_error, 0.0103);
    EXPECT_TRUE(has_note(mesh, "as target_error asks for"));
}

TEST(TargetError, IsNotSpoiltByOutliers) {
    Cloud cloud = shapes::sphere_cloud(20000);
    Random random(1);
    for (int i = 0; i < 200; ++i) cloud.push_back(shapes::in_ball(random) * 3);
    const NeuralMesh mesh = learn(target_of(cloud), settings_for(0.01));
    EXPECT_LE(error_of_sphere(mesh), 0.013);
    EXPECT_LT(mesh.report.vertices, 1000);
}

TEST(TargetError, WarnsIfTheMostVerticesDoNotSuffice) {
    const NeuralMesh mesh = learn(target_of(shapes::sphere_cloud(20000)), settings_for(0.0001, 200));
    EXPECT_EQ(mesh.report.vertices, 200);
    EXPECT_TRUE(has_warning(mesh, "Raise target_vertices"));
    EXPECT_GT(mesh.report.held_out_error, 0.0001);
}

TEST(TargetError, WarnsIfTheNoiseDoesNotAllowIt) {
    const NeuralMesh mesh = learn(target_of(shapes::sphere_cloud(20000, 0.03)), settings_for(0.0005));
    EXPECT_LT(mesh.report.vertices, 10000);
    EXPECT_TRUE(has_warning(mesh, "noise or the number of the points"));
}

/// Those of a run, but no start mesh has fewer than \p least vertices. Counts the start meshes in \p made.
OuterStages stages_from(int least, int& made) {
    OuterStages stages;
    stages.prepare = [least, &made](const TargetSpace& target, const Settings& settings, Progress& progress) {
        ++made;
        if (settings.target_vertices < least) throw SettingError("Too few.");
        return prepare(target, settings, {}, progress);
    };
    stages.finish = [](const LearningTask& /*task*/, const LearnedNetwork& learned) {
        NeuralMesh mesh;
        mesh.report.vertices = learned.network.vertex_count();
        return mesh;
    };
    return stages;
}

TEST(TargetError, TriesMoreVerticesWhereTooFewMakeNoMesh) {
    const TargetSpace target = target_of(shapes::sphere_cloud(6000));
    int made = 0;
    const NeuralMesh mesh = learn_to_error(target, settings_for(0.002), unwatched(), stages_from(1600, made));
    EXPECT_GE(mesh.report.vertices, 1600);
    EXPECT_LE(made, 3);
    EXPECT_THROW(learn_to_error(target, settings_for(0.1, 500), unwatched(), stages_from(600, made)),
                 SettingError);
}

TEST(TargetError, LeavesNoComponentOut) {
    Cloud cloud;
    for (int i = 0; i < 36; ++i)
        for (const vcg::Point3d& p : shapes::sphere_cloud(150))
            cloud.push_back(p + vcg::Point3d(3.0 * (i % 6), 3.0 * (i / 6), 0));
    const NeuralMesh mesh = learn(target_of(cloud), settings_for(0.3));
    EXPECT_EQ(topology_of(mesh), (Topology{36, 0, 0}));
}

TEST(TargetError, IsLeftWhereItIsIfAskedToStop) {
    Watch stop(0);
    const TargetSpace target = target_of(shapes::sphere_cloud(6000));
    int made = 0;
    learn_to_error(target, settings_for(0.001), stop, stages_from(4, made));
    EXPECT_EQ(made, 1);
    const NeuralMesh mesh = reconstruct(target, settings_for(0.001), stop);
    EXPECT_EQ(mesh.report.stop_reason, StopReason::cancelled);
    EXPECT_FALSE(mesh.faces.empty());
}

}  // namespace neuralmesh::target_error_test
