// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Batches give the same bytes for any number of threads.
#include "vcg_core/engine/basic_step_batch.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

/// A network and its batches of Basic Steps on the given number of threads.
struct BatchRun {
    BatchRun(const TargetSpace& target, int threads)
        : network(start(target)), search(network), steps(threads) {}

    static Network start(const TargetSpace& target) {
        return targets::network_in_frame(target, shapes::torus_grid(40, 24));
    }

    Network network;
    WinnerSearch search;
    BasicStepBatch steps;
    std::vector<StepResult> results;  ///< of the last batch
};

void expect_same(const BatchRun& a, const BatchRun& b) {
    ASSERT_EQ(a.results.size(), b.results.size());
    for (std::size_t i = 0; i < a.results.size(); ++i) {
        ASSERT_EQ(a.results[i].winner, b.results[i].winner) << "signal " << i;
        ASSERT_EQ(a.results[i].delta, b.results[i].delta) << "signal " << i;
    }
    ASSERT_EQ(a.network.slot_count(), b.network.slot_count());
    for (VertexId v = 0; v < a.network.slot_count(); ++v) {
        ASSERT_EQ(a.network.position(v), b.network.position(v)) << "vertex " << v;
    }
}

TEST(BasicStepBatch, GivesTheSameBytesForAnyNumberOfThreads) {
    const shapes::Cloud cloud = shapes::torus_cloud(5000, 0.01);
    const TargetSpace target = targets::target_of(cloud);
    BatchRun alone(target, 1);
    BatchRun two(target, 2);
    BatchRun five(target, 5);
    Random random(3);
    const StepRates rates{0.06F, 0.05F, 5};
    std::vector<vcg::Point3f> drawn(1000);
    for (int batch = 0; batch < 100; ++batch) {
        // Many signals for few vertices: most vertices are moved by steps of several threads.
        const int count = 240 + static_cast<int>(random.below(760));
        for (int i = 0; i < count; ++i) drawn[static_cast<std::size_t>(i)] = target.sample(random);
        const auto v = static_cast<VertexId>(random.below(900));
        for (BatchRun* run : {&alone, &two, &five}) {
            run->results = run->steps.take(drawn.data(), count, rates, run->network, run->search);
            ASSERT_EQ(static_cast<int>(run->results.size()), count);
            if (!run->network.can_split(v, 0, 4)) continue;
            run->search.add(run->network.split(v, 0, 4, run->network.position(v)));
            run->search.rebuild_if_outgrown();
        }
        expect_same(alone, two);
        expect_same(alone, five);
        if (testing::Test::HasFatalFailure()) FAIL() << "in batch " << batch;
    }
}

}  // namespace
}  // namespace neuralmesh
