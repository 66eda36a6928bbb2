// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs: what is learned, progress, stop reasons.
#include "vcg_core/reconstruct.h"

#include "tests/unit/support/runs.h"

namespace neuralmesh::reconstruct_test {

TEST(Reconstruct, LiesOnTheSphereItLearned) {
    for (const int start : {kShell, kTetrahedron}) {
        const NeuralMesh mesh = learn(shapes::sphere_cloud(20000), with_target(1000, start));
        const double sphere = 4.0 / 3 * shapes::kPi;
        EXPECT_NEAR(enclosed_volume(mesh), sphere, 0.02 * sphere);
        for (const vcg::Point3d& p : mesh.positions) EXPECT_NEAR(p.Norm(), 1, 0.05);
        EXPECT_LT(mesh.report.rms_error, 0.3);
    }
}

// The points that judge the fit took part in the learning, which has followed their noise: they speak for the
// learned mesh, with a root mean square of .0063.
TEST(Reconstruct, FollowsNoNoiseOfFewPoints) {
    constexpr double kDeviation = 0.0085;  // .1 mean edges
    const double of_ball = kDeviation * std::sqrt(5.0);
    for (const std::uint64_t seed : {1, 4, 9}) {
        Settings settings = with_target(2000);
        settings.random_seed = static_cast<int>(seed);
        const NeuralMesh mesh = learn(shapes::sphere_cloud(4000, of_ball, seed), settings);
        double squares = 0;
        for (const vcg::Point3d& p : mesh.positions) squares += (p.Norm() - 1) * (p.Norm() - 1);
        EXPECT_LT(std::sqrt(squares / 2000), 0.4 * kDeviation) << seed;
    }
}

/// Degrees from the normals of \p mesh to those of the unit sphere, mean over the faces.
double normals_off_sphere(const NeuralMesh& mesh) {
    double sum = 0;
    for (const Triangle& f : mesh.faces) {
        const vcg::Point3d normal = area_of(mesh, f), out = middle_of(mesh, f);
        sum += std::acos(std::clamp(normal * out / (normal.Norm() * out.Norm()), -1.0, 1.0));
    }
    return sum / static_cast<double>(mesh.faces.size()) * 180 / shapes::kPi;
}

// Vertices that the noisy points cannot place followed their noise: normals were off by 20 to 30 degrees.
TEST(Reconstruct, IsAsSmoothWithMoreVerticesThanNoiseAllows) {
    const Cloud cloud = shapes::sphere_cloud(4000, 0.1);
    const double coarse = normals_off_sphere(learn(cloud, with_target(400)));
    EXPECT_LT(normals_off_sphere(learn(cloud, with_target(1600))), coarse + 3);
}

// From the shell the fit keeps 2,000 of some 6,700 vertices, on a sphere almost at random.
TEST(Reconstruct, MostValencesAreRegular) {
    for (const auto& [start, share] : {std::pair(kShell, 0.85), std::pair(kTetrahedron, 0.95)}) {
        const NeuralMesh mesh = learn(shapes::sphere_cloud(20000), with_target(2000, start));
        int regular = 0;
        for (const auto& entry : census(mesh.faces).valence)
            regular += entry.second >= 5 && entry.second <= 7 ? 1 : 0;
        EXPECT_GE(regular, share * 2000);
    }
}

TEST(Reconstruct, ProgressNeverGoesBack) {
    for (const int start : {kShell, kTetrahedron}) {
        Watch watch;
        reconstruct(target_of(shapes::torus_cloud(5000)), with_target(1500, start), watch);
        EXPECT_GT(watch.calls, 50);
        EXPECT_EQ(watch.steps_back, 0) << "of " << watch.calls;
    }
}

TEST(Reconstruct, StopsWhenConverged) {
    Settings settings = with_target(5000);
    settings.stop_below_mean_counter = 1000;
    const NeuralMesh mesh = learn(shapes::sphere_cloud(3000), settings);
    EXPECT_EQ(mesh.report.stop_reason, StopReason::converged);
    EXPECT_LT(mesh.report.vertices, 5000);
    expect_sound(mesh);
}

TEST(Reconstruct, EdgesFollowCreases) {
    const NeuralMesh mesh = learn(shapes::box_cloud(20000), with_target(1500));
    expect_sound(mesh);
    // .0104 if no vertex moves to a crease for the sake of flips.
    EXPECT_LT(mesh.report.rms_error, 0.008);
}

TEST(Reconstruct, FeatureThresholdSelectsByTheMean) {
    Settings settings = with_target(300);
    settings.settling_signals_per_vertex = 10;
    settings.select_by = kFeatureCounter;
    settings.feature_threshold = 0;
    const NeuralMesh all = learn(shapes::box_cloud(3000), settings);
    settings.feature_threshold = 1000;
    const NeuralMesh none = learn(shapes::box_cloud(3000), settings);
    EXPECT_GT(all.report.feature_vertices, 290);
    EXPECT_EQ(none.report.feature_vertices, 0);
    double sum = 0;
    for (const float counter : all.counters) sum += static_cast<double>(counter);
    EXPECT_NEAR(sum / 300, all.report.mean_counter, 1e-4 * all.report.mean_counter);
}

/// A choice of one for what the quality holds and for what selects, in all four combinations.
TEST(Reconstruct, SelectsByOneMeasureAndShowsTheOther) {
    Settings settings = with_target(300);
    const Cloud box = shapes::box_cloud(3000);
    settings.feature_measure = settings.select_by = kFeatureCounter;
    const NeuralMesh counter = learn(box, settings);
    settings.feature_measure = settings.select_by = kCreaseMeasure;
    const NeuralMesh crease = learn(box, settings);
    EXPECT_NE(counter.counters, crease.counters);
    EXPECT_NE(counter.features, crease.features);
    for (std::size_t i = 0; i < crease.features.size(); ++i)
        EXPECT_EQ(crease.features[i] != 0, crease.counters[i] > 1) << i;
    for (const int shown : {kFeatureCounter, kCreaseMeasure}) {
        for (const int selecting : {kFeatureCounter, kCreaseMeasure}) {
            if (shown == selecting) continue;  // as above
            settings.feature_measure = shown;
            settings.select_by = selecting;
            const NeuralMesh mesh = learn(box, settings);
            EXPECT_EQ(mesh.counters, (shown == kCreaseMeasure ? crease : counter).counters);
            EXPECT_EQ(mesh.features, (selecting == kCreaseMeasure ? crease : counter).features);
            EXPECT_EQ(mesh.positions, counter.positions);
        }
    }
    EXPECT_EQ(learn(box, with_target(300)).features, crease.features) << "not the default";
}

}  // namespace neuralmesh::reconstruct_test
