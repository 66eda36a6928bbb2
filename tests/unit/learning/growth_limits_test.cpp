// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Saturation.
#include "vcg_core/learning/growth_limits.h"

#include "tests/unit/support/prelude.h"

namespace neuralmesh::growth_limits_test {

/// Periods until a network of \p vertices that gains \p gained of 1,000 due splits in each is saturated; 0:
/// not in a hundred.
int periods_until_saturated(Saturation& saturation, int vertices, int gained) {
    for (int period = 1; period <= 100; ++period)
        if (saturation.reached(vertices + period * gained, std::int64_t{1000} * period)) return period;
    return 0;
}

TEST(Saturation, IsNotReachedWhileSplitsEnlargeTheNetwork) {
    for (const int gained : {1000, 500, 110}) {
        Saturation saturation;
        EXPECT_EQ(periods_until_saturated(saturation, 3000, gained), 0) << gained;
    }
}

TEST(Saturation, IsReachedWhereCollapsesOrNoiseUndoSplits) {
    for (const int gained : {90, 0, -20}) {
        Saturation saturation;
        const int periods = periods_until_saturated(saturation, 3000, gained);
        EXPECT_GE(periods, 4) << gained;
        EXPECT_LE(periods, 5) << gained;
    }
}

TEST(Saturation, IsNotReachedWhileTheStartMeshIsThinnedOut) {
    Saturation saturation;
    int vertices = 5000;
    std::int64_t due = 0;
    const auto period = [&](int gained) { return saturation.reached(vertices += gained, due += 1000); };
    for (const int gained : {0, -800, -200, 50, 400, 500, 50, 60, 70}) EXPECT_FALSE(period(gained)) << gained;
    EXPECT_TRUE(period(40));
}

}  // namespace neuralmesh::growth_limits_test
