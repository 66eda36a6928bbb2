// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Meshes that have as many vertices as an error asks for.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/support/environment.h"
#include "tests/unit/support/soundness.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/learn_to_error.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;

Settings settings_for(double error, int most = 10000) {
    Settings settings;
    settings.target_error = error;
    settings.target_vertices = most;
    return settings;
}

NeuralMesh learn(const TargetSpace& target, const Settings& settings) {
    NoProgress progress;
    return reconstruct(target, settings, progress);
}

/// Root mean square of the distances of points spread over the faces, all alike, to the sphere of radius 1.
double error_of_sphere(const NeuralMesh& mesh) {
    constexpr int kPerEdge = 8;
    double sum = 0;
    int count = 0;
    for (const auto& f : mesh.faces) {
        const auto at = [&](std::size_t k) { return mesh.positions[static_cast<std::size_t>(f[k])]; };
        for (int i = 0; i < kPerEdge; ++i)
            for (int j = 0; i + j < kPerEdge; ++j, ++count) {
                const double u = (i + 1.0 / 3) / kPerEdge, v = (j + 1.0 / 3) / kPerEdge;
                const double off = (at(0) * u + at(1) * v + at(2) * (1 - u - v)).Norm() - 1;
                sum += off * off;
            }
    }
    return std::sqrt(sum / count);
}

TEST(TargetError, IsReachedWithoutAndWithNoise) {
    for (const double noise : environment::in_tiers<double>({0.01}, {0}))
        for (const double error : environment::in_tiers<double>({0.01}, {0.004})) {
            const NeuralMesh mesh =
                learn(targets::target_of(shapes::sphere_cloud(20000, noise)), settings_for(error));
            EXPECT_LE(mesh.report.held_out_error, 1.03 * error) << noise;
            EXPECT_GE(mesh.report.held_out_error, 0.8 * error) << noise;
            EXPECT_LE(error_of_sphere(mesh), 1.15 * error) << noise;
            EXPECT_GE(error_of_sphere(mesh), 0.8 * error) << noise;
            EXPECT_LT(mesh.report.vertices, 2000);
            EXPECT_EQ(mesh.report.vertices, static_cast<int>(mesh.positions.size()));
            EXPECT_TRUE(soundness::has_note(mesh, "as target_error asks for"));
        }
}

TEST(TargetError, IsThatOfFacesToo) {
    const NeuralMesh mesh = learn(targets::target_of(shapes::icosphere(4)), settings_for(0.01, 300));
    EXPECT_LE(mesh.report.held_out_error, 0.0103);
    EXPECT_TRUE(soundness::has_note(mesh, "as target_error asks for"));
}

TEST(TargetError, IsNotSpoiltByOutliers) {
    Cloud cloud = shapes::sphere_cloud(20000);
    Random random(1);
    for (int i = 0; i < 200; ++i) cloud.push_back(shapes::in_ball(random) * 3);
    const NeuralMesh mesh = learn(targets::target_of(cloud), settings_for(0.01));
    EXPECT_LE(error_of_sphere(mesh), 0.013);
    EXPECT_LT(mesh.report.vertices, 1000);
}

TEST(TargetError, WarnsIfTheMostVerticesDoNotSuffice) {
    const NeuralMesh mesh = learn(targets::target_of(shapes::sphere_cloud(20000)), settings_for(0.0001, 200));
    EXPECT_EQ(mesh.report.vertices, 200);
    EXPECT_TRUE(soundness::has_warning(mesh, "Raise target_vertices"));
    EXPECT_GT(mesh.report.held_out_error, 0.0001);
}

TEST(TargetError, WarnsIfTheNoiseDoesNotAllowIt) {
    const NeuralMesh mesh =
        learn(targets::target_of(shapes::sphere_cloud(20000, 0.03)), settings_for(0.0005));
    EXPECT_LT(mesh.report.vertices, 10000);
    EXPECT_TRUE(soundness::has_warning(mesh, "noise or the number of the points"));
}

/// A sphere of as many vertices as asked for, but none below \p least.
Learn spheres_from(int least, int& calls) {
    return [least, &calls](const TargetSpace& /*target*/, const Settings& settings, Progress& progress) {
        ++calls;
        if (settings.target_vertices < least) throw SettingError("Too few.");
        NeuralMesh mesh;
        const shapes::Shape sphere = shapes::icosphere(settings.target_vertices < 900 ? 2 : 3);
        mesh.positions = sphere.positions;
        mesh.faces = sphere.faces;
        progress(1, "done");
        return mesh;
    };
}

TEST(TargetError, TriesMoreVerticesWhereTooFewMakeNoMesh) {
    const TargetSpace target = targets::target_of(shapes::sphere_cloud(20000));
    NoProgress progress;
    int calls = 0;
    EXPECT_EQ(learn_to_error(target, settings_for(0.1), progress, spheres_from(600, calls)).faces.size(),
              320U);
    EXPECT_LT(calls, 12);
    EXPECT_EQ(learn_to_error(target, settings_for(0.1), progress, spheres_from(5000, calls)).faces.size(),
              1280U);
    EXPECT_THROW(learn_to_error(target, settings_for(0.1, 500), progress, spheres_from(600, calls)),
                 SettingError);
}

TEST(TargetError, IsLeftWhereItIsIfAskedToStop) {
    class StopAtOnce : public Progress {
        bool operator()(double, const char*) override { return false; }
    } stop;
    int calls = 0;
    const TargetSpace target = targets::target_of(shapes::sphere_cloud(20000));
    EXPECT_FALSE(learn_to_error(target, settings_for(0.001), stop, spheres_from(4, calls)).faces.empty());
    EXPECT_EQ(calls, 1);
}

TEST(TargetError, OfFewPointsStillHasAMesh) {
    for (const int points : {4, 100})
        EXPECT_FALSE(
            learn(targets::target_of(shapes::sphere_cloud(points)), settings_for(0.01, 100)).faces.empty())
            << points;
}

}  // namespace
}  // namespace neuralmesh
