// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs: exact number of vertices, manifold, orientation, progress, stop reasons; also with settings and
// clouds chosen to break them.
#include "vcg_core/reconstruct.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learning/learner.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;
using soundness::expect_exact;
using soundness::expect_sound;
using soundness::target_of;

/// Checks fractions and texts; asks to stop after \p patience calls.
class Watch : public Progress {
public:
    explicit Watch(int patience = 1 << 30) : patience_(patience) {}

    bool operator()(double fraction, const char* text) override {
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1);
        if (fraction < last_) ++steps_back;
        last_ = fraction;
        EXPECT_GT(std::string(text).size(), 3U);
        return ++calls <= patience_;
    }

    int calls = 0;
    int steps_back = 0;

private:
    int patience_;
    double last_ = 0;
};

NeuralMesh learn(const Cloud& cloud, const Settings& settings) {
    NoProgress progress;
    return reconstruct(target_of(cloud), settings, progress);
}

Settings with_target(int vertices, int start_mesh = kShell) {
    Settings settings;
    settings.target_vertices = vertices;
    settings.start_mesh = start_mesh;
    return settings;
}

TEST(Reconstruct, GivesTheExactCountAsAClosedOutwardSurface) {
    const std::pair<const char*, Cloud> clouds[] = {{"sphere", shapes::sphere_cloud(3000)},
                                                    {"noisy sphere", shapes::sphere_cloud(3000, 0.05)},
                                                    {"torus", shapes::torus_cloud(3000)},
                                                    {"cube", shapes::box_cloud(3000)},
                                                    {"slab", shapes::box_cloud(3000, {1, 0.7, 0.1})},
                                                    {"needle", shapes::box_cloud(3000, {1, 0.05, 0.05})}};
    for (const auto& cloud : clouds) {
        for (const int start : {kShell, kTetrahedron}) {
            for (const int vertices : {4, 17, 100, 501}) {
                SCOPED_TRACE(testing::Message() << cloud.first << ", start " << start << ", " << vertices);
                const Settings settings = with_target(vertices, start);
                const NeuralMesh mesh = learn(cloud.second, settings);
                expect_exact(mesh, settings);
                EXPECT_GT(referee::enclosed_volume(mesh), 0);
            }
        }
    }
}

TEST(Reconstruct, LiesOnTheSphereItLearned) {
    for (const int start : {kShell, kTetrahedron}) {
        const NeuralMesh mesh = learn(shapes::sphere_cloud(20000), with_target(1000, start));
        const double sphere = 4.0 / 3 * shapes::kPi;
        EXPECT_NEAR(referee::enclosed_volume(mesh), sphere, 0.02 * sphere);
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

TEST(Reconstruct, LearnsFromFaces) {
    const shapes::Shape shape = shapes::icosphere(3);
    const TargetSpace target = TargetSpace::triangles(shape.faces.size(), [&](std::size_t i, int k) {
        return shape.positions[static_cast<std::size_t>(shape.faces[i][static_cast<std::size_t>(k)])];
    });
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(target, with_target(500), progress);
    expect_exact(mesh, with_target(500));
    EXPECT_EQ(mesh.report.genus, 0);
}

// From the shell the fit keeps 2,000 of some 6,700 vertices, on a sphere almost at random.
TEST(Reconstruct, MostValencesAreRegular) {
    for (const auto& [start, share] : {std::pair(kShell, 0.85), std::pair(kTetrahedron, 0.95)}) {
        const NeuralMesh mesh = learn(shapes::sphere_cloud(20000), with_target(2000, start));
        int regular = 0;
        for (const auto& entry : referee::census(mesh.faces).valence)
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

TEST(Reconstruct, CanBeCancelledAtAnyTime) {
    // From the shell, the network grows to more than 300 vertices.
    const TargetSpace target = target_of(shapes::sphere_cloud(12000));
    for (const int start : {kShell, kTetrahedron}) {
        Watch all;
        reconstruct(target, with_target(300, start), all);
        for (int patience = 0; patience < all.calls; patience += std::max(1, all.calls / 30)) {
            SCOPED_TRACE(testing::Message()
                         << "start " << start << ", after " << patience << " of " << all.calls);
            Watch watch(patience);
            const NeuralMesh mesh = reconstruct(target, with_target(300, start), watch);
            EXPECT_EQ(mesh.report.stop_reason, StopReason::cancelled);
            EXPECT_LE(watch.calls, patience + 3);
            EXPECT_LE(mesh.report.vertices, 300);
            expect_sound(mesh);
        }
    }
}

/// Adds up the signals in the progress texts, including those of a growth whose result was discarded.
class SignalCount : public Progress {
public:
    bool operator()(double, const char* text) override {
        long long signals = 0;
        if (std::sscanf(text, "Learning: %*d vertices, %lld", &signals) != 1) return true;
        if (signals < last_) {
            ++discarded;
            before_ += last_;
        }
        last_ = signals;
        return true;
    }
    long long all() const { return before_ + last_; }

    int discarded = 0;

private:
    long long before_ = 0;
    long long last_ = 0;
};

TEST(Reconstruct, CountsTheSignalsOfADiscardedGrowth) {
    Settings settings = with_target(150);
    settings.signals_per_collapse = 1;  // growth stalls
    SignalCount counted;
    const NeuralMesh mesh = reconstruct(target_of(shapes::sphere_cloud(20000)), settings, counted);
    expect_exact(mesh, settings);
    ASSERT_EQ(counted.discarded, 1);
    EXPECT_GE(mesh.report.signals, counted.all());
    EXPECT_EQ(mesh.report.faces, 296);
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

// With it, where the points have no noise, half of the signals or fewer settle the network.
TEST(Reconstruct, SettlesWithAllSignalsWithoutTheFit) {
    constexpr int kVertices = 1000, kSignalsPerVertex = 200;
    const Cloud sphere = shapes::sphere_cloud(10000);
    const auto signals_with = [&](int settling_signals_per_vertex) {
        Settings settings = with_target(kVertices);
        settings.fit_to_points = false;
        settings.settling_signals_per_vertex = settling_signals_per_vertex;
        return learn(sphere, settings).report.signals;
    };
    EXPECT_EQ(signals_with(kSignalsPerVertex) - signals_with(0), kVertices * kSignalsPerVertex);
}

TEST(Reconstruct, LearnsBrieflyWhereTheFitFollowsAndTheNoiseIsLarge) {
    const auto signals = [](double noise, bool fit) {
        Settings settings = with_target(1000);
        settings.fit_to_points = fit;
        return static_cast<double>(learn(shapes::sphere_cloud(20000, noise), settings).report.signals);
    };
    // In a ball of this radius: across the surface .45 of it. The edges of 1,000 vertices are .12 long.
    EXPECT_LT(signals(0.08, true), 0.75 * signals(0.02, true));
    EXPECT_GT(signals(0.08, false), 0.9 * signals(0.02, false));
}

TEST(Reconstruct, RefusesSettingsOutOfRange) {
    Settings settings = with_target(3);
    EXPECT_THROW(learn(shapes::sphere_cloud(100), settings), SettingError);
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

std::vector<std::pair<const char*, Cloud>> hostile_clouds() {
    Cloud two = shapes::sphere_cloud(1000);
    for (std::size_t i = 0; i < two.size(); ++i)
        two[i] = two[i] * 0.001 + vcg::Point3d(i % 2 == 0 ? 1 : -1, 0, 0);
    Cloud outlier = shapes::sphere_cloud(1000);
    outlier.push_back({1e5, 0, 0});
    Cloud doubled = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (int i = 0; i < 8; ++i) doubled.insert(doubled.end(), doubled.begin(), doubled.end());
    Cloud cross;
    for (int i = -50; i <= 50; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            vcg::Point3d p(0, 0, 0);
            p[axis] = i;
            cross.push_back(p);
        }
    Cloud thin = shapes::box_cloud(1000, {1, 1e-5, 1e-5});
    return {{"four points", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
            {"four points in a plane", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}},
            {"plane", shapes::plane_cloud(1000)},
            {"two small clusters", two},
            {"one far outlier", outlier},
            {"five points, many times", doubled},
            {"three crossing lines", cross},
            {"almost a line", thin}};
}

TEST(Reconstruct, HostileCloudsStillGiveTheExactCount) {
    for (const auto& cloud : hostile_clouds()) {
        for (const int start : {kShell, kTetrahedron}) {
            SCOPED_TRACE(testing::Message() << cloud.first << ", start " << start);
            const Settings settings = with_target(200, start);
            expect_exact(learn(cloud.second, settings), settings);
        }
    }
}

std::vector<std::pair<const char*, Settings>> hostile_settings() {
    std::vector<std::pair<const char*, Settings>> result;
    const auto add = [&](const char* name, const auto& change) {
        Settings settings = with_target(150, kTetrahedron);
        settings.fit_to_points = false;
        change(settings);
        result.emplace_back(name, settings);
    };
    add("no maturity", [](Settings& s) { s.min_wins_per_split = 0; });
    add("collapse at every chance", [](Settings& s) { s.signals_per_collapse = 1; });
    add("both", [](Settings& s) { s.min_wins_per_split = 0, s.signals_per_collapse = 1; });
    add("split at every signal", [](Settings& s) { s.signals_per_split = 1; });
    add("split and collapse at every signal",
        [](Settings& s) { s.signals_per_split = s.signals_per_collapse = 1; });
    add("maturity beyond reach", [](Settings& s) {
        s.min_wins_per_split = 1000;
        s.signals_per_split = 1;
    });
    add("no counter decay", [](Settings& s) { s.counter_decay = 1; });
    add("fastest counter decay", [](Settings& s) { s.counter_decay = 0.01; });
    add("the last signal alone", [](Settings& s) { s.normalization_window = 1; });
    add("no feature memory", [](Settings& s) { s.feature_decay = 0; });
    add("winner jumps onto the signal", [](Settings& s) { s.learning_rate = 1; });
    add("no smoothing", [](Settings& s) { s.smoothing_steps = 0; });
    add("strongest smoothing", [](Settings& s) { s.smoothing_steps = 100, s.smoothing_rate = 1; });
    add("no settling", [](Settings& s) { s.settling_signals_per_vertex = 0; });
    add("signal counter to the letter",
        [](Settings& s) { s.utility_counter = kSignalCount, s.min_wins_per_split = 0; });
    return result;
}

/// Growth of the learner alone ends within Learner::signal_bound().
void expect_run_within_bound(const Cloud& cloud, Settings settings) {
    settings.settling_signals_per_vertex = 0;
    const TargetSpace target = target_of(cloud);
    constexpr float kA = 0.1F;
    Learner learner(target, learner_options_from(settings),
                    Network({{kA, kA, kA}, {-kA, -kA, kA}, {-kA, kA, -kA}, {kA, -kA, -kA}},
                            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
    NoProgress progress;
    EXPECT_EQ(learner.run(0, progress), StopReason::target_reached);
    EXPECT_EQ(learner.network().vertex_count(), settings.target_vertices);
    EXPECT_EQ(learner.network().validate(), "");
    EXPECT_LE(learner.signals(), learner.signal_bound());
}

TEST(Reconstruct, HostileSettingsEndWithinTheBound) {
    const auto all = hostile_clouds();
    const std::pair<const char*, Cloud> clouds[] = {
        all[0], all[1], all[3], all[6], {"sphere", shapes::sphere_cloud(3000)}};
    for (const auto& settings : hostile_settings()) {
        for (const auto& cloud : clouds) {
            SCOPED_TRACE(testing::Message() << settings.first << ", " << cloud.first);
            expect_run_within_bound(cloud.second, settings.second);
        }
    }
}

TEST(Reconstruct, HostileSettingsGiveSoundMeshes) {
    const Cloud cloud = shapes::torus_cloud(2000);
    for (const auto& entry : hostile_settings()) {
        for (const int start : {kShell, kTetrahedron}) {
            SCOPED_TRACE(testing::Message() << entry.first << ", start " << start);
            Settings settings = entry.second;
            settings.start_mesh = start;
            settings.fit_to_points = true;
            expect_exact(learn(cloud, settings), settings);
        }
    }
}

}  // namespace
}  // namespace neuralmesh
