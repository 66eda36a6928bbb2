// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Many runs in one process: no block leaks, and the process does not grow.
#include "tests/memory/allocations.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::repeated_runs_test {

TEST(RepeatedRuns, LeakNothing) {
    const Cloud cloud = shapes::torus_cloud(500);
    Settings settings = with_target(100);
    settings.settling_signals_per_vertex = 0;
    long long before = 0;
    long long living = 0;
    constexpr int kWarmUp = 20;
    constexpr int kRuns = 30;
    for (int i = 0; i < kWarmUp + kRuns; ++i) {
        if (i == kWarmUp) {
            before = allocations::resident_bytes();
            living = allocations::living();
        }
        settings.start_mesh = i % 4 == 0 ? kShell : kTetrahedron;
        settings.random_seed = i;
        settings.threads = 1 + i % 2;
        learn(cloud, settings);
    }
    EXPECT_EQ(allocations::living(), living);
    const long long grown = allocations::resident_bytes() - before;
    RecordProperty("grown_bytes", std::to_string(grown));
    // The heap of the C library may keep ten kilobytes per run. Blocks of our own are counted above; this
    // finds other memory, such as the stacks of threads.
    EXPECT_LT(grown, kRuns * ((1 << 20) / 100)) << "bytes";
}

}  // namespace neuralmesh::repeated_runs_test
