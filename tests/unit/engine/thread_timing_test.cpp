// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The faster number of threads is chosen from made-up durations, and again when they change.
#include "vcg_core/engine/slab_schedule.h"

#include <gtest/gtest.h>

namespace neuralmesh {
namespace {

constexpr int kEnough = 100;  ///< batches after which a trial is over

/// Runs \p batches batches, and tells \p timing that each took \p one or \p all nanoseconds per signal.
/// \return how many ran on all threads
int run(ThreadTiming& timing, int batches, double one, double all) {
    int on_all = 0;
    for (int i = 0; i < batches; ++i) {
        const bool uses_all = timing.use_all_threads();
        timing.add_batch(uses_all ? all : one);
        on_all += uses_all ? 1 : 0;
    }
    return on_all;
}

TEST(ThreadTiming, ChoosesWhatIsFaster) {
    for (const bool all_are_faster : {true, false}) {
        ThreadTiming timing;
        const double all = all_are_faster ? 200 : 500;
        const int tried = run(timing, kEnough, 400, all);
        EXPECT_GT(tried, 0);
        EXPECT_LT(tried, kEnough);
        EXPECT_EQ(run(timing, kEnough, 400, all), all_are_faster ? kEnough : 0);
    }
}

// As where another program takes the second core for some milliseconds.
TEST(ThreadTiming, IsNotDecidedByOneBatchThatWasInterrupted) {
    for (int interrupted = 0; interrupted < kEnough; ++interrupted) {
        ThreadTiming timing;
        run(timing, interrupted, 400, 200);
        timing.add_batch(1e6);
        run(timing, kEnough, 400, 200);
        EXPECT_TRUE(timing.use_all_threads()) << interrupted;
    }
}

TEST(ThreadTiming, ChoosesAnewWhenTheLoadChanges) {
    constexpr int kMany = 10000;
    ThreadTiming timing;
    run(timing, kMany, 400, 200);
    EXPECT_LT(run(timing, kMany, 400, 900), kMany / 4);
    EXPECT_FALSE(timing.use_all_threads());
}

}  // namespace
}  // namespace neuralmesh
