// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Batches of Basic Steps on several threads against those on one.
#include "vcg_core/engine/basic_step_batch.h"

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"

namespace neuralmesh::basic_step_batch_test {

/// A network that learns batches of random signals.
struct Learning {
    explicit Learning(int threads)
        : network(network_of(shapes::scaled(shapes::torus_grid(70, 40), 0.3))),
          search(network),
          batch(threads) {}
    std::vector<StepResult> take(Random& random, int count) {
        std::vector<vcg::Point3f> signals;
        for (int i = 0; i < count; ++i) {
            const vcg::Point3f at = network.position(static_cast<VertexId>(random.below(2800)));
            signals.push_back(at * (0.98F + 0.04F * random.unit()));
        }
        return batch.take(signals.data(), count, {0.06F, 0.05F, 5}, network, search);
    }

    Network network;
    WinnerSearch search;
    BasicStepBatch batch;
};

/// Enough batches that the slabs of the threads are adapted twice, of many steps across their borders.
TEST(BasicStepBatch, IsTheSameOnAnyNumberOfThreads) {
    for (const int threads : {2, 3, 5}) {
        SCOPED_TRACE(threads);
        Learning alone(1), together(threads);
        Random of_alone(3), of_together(3);
        for (int i = 0; i < 140; ++i) {
            const int count = i % 7 == 0 ? 100 : 300;
            const std::vector<StepResult> expected = alone.take(of_alone, count);
            const std::vector<StepResult> steps = together.take(of_together, count);
            ASSERT_EQ(steps.size(), expected.size());
            for (std::size_t k = 0; k < steps.size(); ++k) {
                ASSERT_EQ(steps[k].winner, expected[k].winner);
                ASSERT_EQ(steps[k].delta, expected[k].delta);
            }
        }
        for (VertexId v = 0; v < alone.network.slot_count(); ++v)
            ASSERT_EQ(together.network.position(v), alone.network.position(v)) << v;
        EXPECT_EQ(together.network.validate(), "");
    }
}

}  // namespace neuralmesh::basic_step_batch_test
