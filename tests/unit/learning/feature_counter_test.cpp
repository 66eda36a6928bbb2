// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Equations 6 and 7 by hand.
#include "vcg_core/learning/feature_counter.h"

#include <gtest/gtest.h>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

TEST(FeatureCounters, FollowEquation6) {
    FeatureCounters counters(0.9);
    counters.resize(2);
    double by_hand = 0;
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const double n_delta = 3 * static_cast<double>(random.unit());
        counters.win(1, n_delta);
        by_hand = 0.9 * by_hand + 0.1 * n_delta;
        ASSERT_NEAR(static_cast<double>(counters.value(1)), by_hand, 3e-6);
    }
    EXPECT_EQ(counters.value(0), 0);
    counters.resize(3);
    counters.inherit(1, 2);
    EXPECT_EQ(counters.value(2), counters.value(1));
}

TEST(FeatureCounters, RenumberedAreTheSameUnderNewIds) {
    FeatureCounters counters(0.9);
    counters.resize(3);
    for (VertexId v = 0; v < 3; ++v) counters.win(v, v + 1);
    const FeatureCounters before = counters;
    counters.renumber({2, -1, 0, 1});
    EXPECT_EQ(counters.value(0), before.value(2));
    EXPECT_EQ(counters.value(1), 0);
    EXPECT_EQ(counters.value(2), before.value(0));
    EXPECT_EQ(counters.value(3), before.value(1));
}

TEST(FeatureThreshold, IsAMultipleOfTheMean) { EXPECT_DOUBLE_EQ(feature_threshold(1.5, 0.8), 1.2); }

}  // namespace
}  // namespace neuralmesh
