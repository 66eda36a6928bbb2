// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The learner against the reference, step by step, and properties of whole runs.
#include "vcg_core/learning/learner.h"

#include "tests/unit/reference/reference_learner.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::learner_test {

Network start_of(const Shape& shape, double scale) { return network_of(shapes::scaled(shape, scale)); }

/// Equal connectivity and wins, positions within \p tolerance, counters within 1 %: delta is a difference of
/// nearly equal normals, of which float leaves few digits.
void expect_same_state(const Learner& learner, const reference::ReferenceLearner& expected, float tolerance) {
    ASSERT_EQ(learner.network().faces(), expected.network().faces());
    ASSERT_EQ(learner.network().slot_count(), expected.network().slot_count());
    for (const VertexId v : learner.network().vertices()) {
        ASSERT_LT((learner.network().position(v) - expected.network().position(v)).Norm(), tolerance) << v;
        ASSERT_EQ(learner.utility_counters().wins(v), expected.wins[v]) << v;
        ASSERT_NEAR(learner.utility_counters().value(v), expected.utility[v],
                    0.01 * expected.utility[v] + 1e-3)
            << v;
        ASSERT_NEAR(static_cast<double>(learner.feature_counters().value(v)), expected.feature[v],
                    0.01 * expected.feature[v] + 1e-3)
            << v;
    }
}

/// Runs are short: once a crumpled star has nearly no area, float and double learn different meshes.
void compare_runs(const Cloud& cloud, const Network& start, LearnerOptions options, int signals,
                  int batch = 1) {
    options.grow_to = 100000;
    const TargetSpace target = target_of(cloud);
    Learner learner(target, options, start);
    reference::ReferenceLearner expected(start, options);
    Random random(3);
    int last_collapse = 0;
    int at_collapse = start.vertex_count();
    for (int i = 0; i < signals;) {
        std::vector<vcg::Point3f> drawn;
        while (static_cast<int>(drawn.size()) < batch) drawn.push_back(target.sample(random));
        const std::vector<StepResult>& steps = learner.basic_steps(drawn.data(), batch);
        const std::vector<reference::BasicStep>& expected_steps = expected.basic_steps(drawn);
        ASSERT_EQ(steps.size(), drawn.size());
        for (std::size_t step = 0; step < drawn.size(); ++step) {
            ASSERT_EQ(steps[step].winner, expected_steps[step].winner) << "at signal " << i;
            learner.learn_counters(steps[step]);
            expected.learn_counters(expected_steps[step]);
            if (++i % options.signals_per_split != 0) continue;
            ASSERT_EQ(learner.vertex_split(), expected.vertex_split()) << "at signal " << i;
            ASSERT_EQ(learner.network().faces(), expected.network().faces())
                << "after the split at signal " << i;
        }
        if (i - last_collapse >= at_collapse * options.signals_per_collapse) {
            ASSERT_EQ(learner.half_edge_collapse(), expected.half_edge_collapse()) << "at signal " << i;
            ASSERT_EQ(learner.network().faces(), expected.network().faces())
                << "after the collapse at signal " << i;
            last_collapse = i;
            at_collapse = learner.network().vertex_count();
        }
        if (i % 100 < batch) expect_same_state(learner, expected, 2e-5F);
        if (testing::Test::HasFatalFailure()) FAIL() << "at signal " << i;
    }
    EXPECT_EQ(learner.signals(), signals);
    EXPECT_GT(learner.splits(), 10);
    EXPECT_EQ(learner.network().validate(), "");
}

TEST(Learner, IsTheReferenceOnASphere) {
    LearnerOptions options;
    options.signals_per_split = 40;
    compare_runs(shapes::sphere_cloud(2000), start_of(shapes::icosphere(1), 0.25), options, 4000);
}

TEST(Learner, IsTheReferenceOnATorusWithTheSignalCounter) {
    LearnerOptions options;
    options.utility_counter = kSignalCount;
    options.signals_per_split = 40;
    compare_runs(shapes::torus_cloud(2000, 0.02), start_of(shapes::torus_grid(10, 6), 0.3), options, 4000);
}

TEST(Learner, IsTheReferenceToTheLetterOfThePaper) {
    LearnerOptions options;
    options.min_wins_per_split = 0;
    options.signals_per_split = 30;
    options.signals_per_collapse = 4;
    compare_runs(shapes::box_cloud(2000), start_of(shapes::icosphere(1), 0.25), options, 1200);
}

TEST(Learner, IsTheReferenceFromATetrahedron) {
    LearnerOptions options;
    options.utility_counter = kSignalCount;
    compare_runs(shapes::sphere_cloud(2000, 0.01), start_of(shapes::tetrahedron(), 0.1), options, 1500);
}

TEST(Learner, IsTheReferenceInBatchesOnOneThreadAndOnThree) {
    LearnerOptions options;
    options.signals_per_split = 40;
    options.min_wins_per_split = 5;
    for (const int threads : {1, 3}) {
        options.threads = threads;
        compare_runs(shapes::sphere_cloud(2000), start_of(shapes::icosphere(1), 0.25), options, 2600, 13);
        compare_runs(shapes::torus_cloud(2000, 0.02), start_of(shapes::torus_grid(20, 12), 0.3), options,
                     1600, 160);
    }
}

/// For the thread sanitizer, too, which takes no whole runs.
TEST(Learner, SettlesAlikeOnOneThreadAndOnTwo) {
    const TargetSpace target = target_of(shapes::torus_cloud(5000));
    LearnerOptions options;
    options.threads = 1;
    Learner alone(target, options, start_of(shapes::torus_grid(70, 50), 0.3));
    ASSERT_TRUE(alone.settle(1, unwatched()));
    options.threads = 2;
    Learner together(target, options, start_of(shapes::torus_grid(70, 50), 0.3));
    ASSERT_TRUE(together.settle(1, unwatched()));
    EXPECT_EQ(together.signals(), alone.signals());
    for (VertexId v = 0; v < alone.network().slot_count(); ++v) {
        ASSERT_EQ(together.network().position(v), alone.network().position(v)) << v;
        ASSERT_EQ(together.feature_counters().value(v), alone.feature_counters().value(v)) << v;
        ASSERT_EQ(together.utility_counters().value(v), alone.utility_counters().value(v)) << v;
    }
}

TEST(Learner, TakesSignalsOneByOneToTheLetter) {
    const TargetSpace target = target_of(shapes::sphere_cloud(100));
    LearnerOptions options;
    const Network start = start_of(shapes::icosphere(3), 0.25);
    EXPECT_EQ(Learner(target, options, start).batch_size(), 642 / Learner::kVerticesPerSignal);
    options.min_wins_per_split = 0;
    EXPECT_EQ(Learner(target, options, start).batch_size(), 1);
}

TEST(Learner, RefusesAStartLargerThanTheTarget) {
    const TargetSpace target = target_of(shapes::sphere_cloud(100));
    LearnerOptions options;
    options.grow_to = 41;
    EXPECT_THROW(Learner(target, options, start_of(shapes::icosphere(1), 0.2)), SettingError);
    options.grow_to = 42;
    EXPECT_NO_THROW(Learner(target, options, start_of(shapes::icosphere(1), 0.2)));
}

/// Watches the fractions while the learner settles.
class Fractions : public Watch {
public:
    bool operator()(double fraction, const char* text) override {
        largest_step = std::max(largest_step, fraction - last);
        if (std::string(text).rfind("Settling", 0) == 0) {
            ++settling;
            standing_still_while_settling += fraction == last ? 1 : 0;
        }
        return Watch::operator()(fraction, text);
    }
    double largest_step = 0;
    int settling = 0;
    int standing_still_while_settling = 0;
};

TEST(Learner, ReportsHowMuchOfTheRunIsDone) {
    const TargetSpace target = target_of(shapes::sphere_cloud(2000));
    LearnerOptions options;
    options.grow_to = 900;
    Learner learner(target, options, start_of(shapes::icosphere(3), 0.25));
    Fractions progress;
    EXPECT_EQ(learner.run(100, progress), StopReason::target_reached);
    EXPECT_GT(progress.settling, 100) << "at the start mesh and at the end";
    EXPECT_EQ(progress.standing_still_while_settling, 0);
    EXPECT_EQ(progress.steps_back, 0);
    EXPECT_LT(progress.largest_step, 0.1);
    EXPECT_GT(progress.last, 0.98);
}

/// After that, signals find the vertices where they are, and move them as if they had never been elsewhere.
TEST(Learner, LearnsFromPlacesThatItReturnsTo) {
    const TargetSpace target = target_of(shapes::torus_cloud(5000));
    const Network start = start_of(shapes::torus_grid(20, 12), 0.3);
    PerVertex<vcg::Point3f> places(start.slot_count());
    for (const VertexId v : start.vertices()) places[v] = start.position(v);
    Learner learner(target, LearnerOptions(), start);
    ASSERT_TRUE(learner.learn_at_rest(5000, unwatched()));
    EXPECT_EQ(learner.signals(), 5000);
    learner.move_to(places);
    for (const VertexId v : start.vertices()) ASSERT_EQ(learner.network().position(v), places[v]);

    Learner fresh(target, LearnerOptions(), start);
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const vcg::Point3f s = target.sample(random);
        learner.basic_step(s);
        fresh.basic_step(s);
    }
    for (const VertexId v : start.vertices())
        ASSERT_EQ(learner.network().position(v), fresh.network().position(v));
}

TEST(Learner, DoesNotObserveTheStartMesh) {
    const TargetSpace target = target_of(shapes::box_cloud(2000));
    LearnerOptions options;
    options.observe_creases = true;
    options.grow_to = 643;
    options.settling_signals_per_vertex = 0;
    Learner learner(target, options, start_of(shapes::icosphere(3), 0.25));
    ASSERT_TRUE(learner.settle(1, unwatched(), false));
    EXPECT_EQ(learner.crease_measure().moments(), 0);
    ASSERT_TRUE(learner.settle(1, unwatched()));
    EXPECT_GT(learner.crease_measure().moments(), 0);
    EXPECT_EQ(learner.run(1, unwatched()), StopReason::target_reached);
    EXPECT_EQ(learner.crease_measure().moments(), 0);
}

}  // namespace neuralmesh::learner_test
