// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Exact number of vertices, manifold and orientation with settings and clouds chosen to break them, and when
// the run is cancelled.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "tests/unit/support/soundness.h"
#include "tests/unit/support/watched_runs.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learning/learner.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;
using soundness::expect_exact;
using soundness::expect_sound;
using soundness::target_of;
using watched_runs::learn_watched;
using watched_runs::Watch;
using watched_runs::with_target;

TEST(Reconstruct, GivesTheExactCountAsAClosedOutwardSurface) {
    const std::pair<const char*, Cloud> clouds[] = {{"sphere", shapes::sphere_cloud(3000)},
                                                    {"noisy sphere", shapes::sphere_cloud(3000, 0.05)},
                                                    {"torus", shapes::torus_cloud(3000)},
                                                    {"cube", shapes::box_cloud(3000)},
                                                    {"slab", shapes::box_cloud(3000, {1, 0.7, 0.1})},
                                                    {"needle", shapes::box_cloud(3000, {1, 0.05, 0.05})}};
    constexpr int kCounts[] = {4, 17, 100,
                               501};  // all pairs of two of cloud, start mesh and number that fit in
    int run = 0;
    for (const auto& cloud : clouds) {
        for (const int start : {kShell, kTetrahedron}) {
            const int vertices = kCounts[(run + run / 4) % 4];
            ++run;
            SCOPED_TRACE(testing::Message() << cloud.first << ", start " << start << ", " << vertices);
            const Settings settings = with_target(vertices, start);
            const NeuralMesh mesh = learn_watched(cloud.second, settings);
            expect_exact(mesh, settings);
            EXPECT_GT(referee::enclosed_volume(mesh), 0);
        }
    }
}

TEST(Reconstruct, CanBeCancelledAtAnyTime) {
    // From the shell, the network grows to more than 300 vertices.
    const TargetSpace target = target_of(shapes::sphere_cloud(12000));
    for (const int start : {kShell, kTetrahedron}) {
        Watch all;
        reconstruct(target, with_target(300, start), all);
        for (int patience = 0; patience < all.calls; patience += std::max(1, all.calls / 5)) {
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

struct HostileCloud {
    const char* name;
    Cloud cloud;
    int surface = kAutomatic;
};

/// Curves have a closed surface around them if it is asked for, and else none.
std::vector<HostileCloud> hostile_clouds() {
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
            {"three crossing lines", cross, kClosedSurface},
            {"almost a line", thin, kClosedSurface}};
}

TEST(Reconstruct, HostileCloudsStillGiveTheExactCount) {
    int start = kTetrahedron;
    for (const HostileCloud& hostile : hostile_clouds()) {
        start = start == kShell ? kTetrahedron : kShell;
        SCOPED_TRACE(testing::Message() << hostile.name << ", start " << start);
        Settings settings = with_target(200, start);
        settings.surface = hostile.surface;
        expect_exact(learn_watched(hostile.cloud, settings), settings);
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

/// Every second setting; HostileSettingsGiveSoundMeshes has the others.
TEST(Reconstruct, HostileSettingsEndWithinTheBound) {
    const auto all = hostile_clouds();
    const HostileCloud clouds[] = {all[0], all[1], all[3], all[6], {"sphere", shapes::sphere_cloud(3000)}};
    const auto settings = hostile_settings();
    for (std::size_t i = 1; i < settings.size(); i += 2) {
        const HostileCloud& hostile = clouds[i / 2 % std::size(clouds)];
        SCOPED_TRACE(testing::Message() << settings[i].first << ", " << hostile.name);
        expect_run_within_bound(hostile.cloud, settings[i].second);
    }
}

TEST(Reconstruct, HostileSettingsGiveSoundMeshes) {
    const Cloud cloud = shapes::torus_cloud(2000);
    const auto hostile = hostile_settings();
    for (std::size_t i = 0; i < hostile.size(); i += 2) {
        const int start = i % 4 == 0 ? kShell : kTetrahedron;
        SCOPED_TRACE(testing::Message() << hostile[i].first << ", start " << start);
        Settings settings = hostile[i].second;
        settings.start_mesh = start;
        settings.fit_to_points = true;
        expect_exact(learn_watched(cloud, settings), settings);
    }
}

}  // namespace
}  // namespace neuralmesh
