// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/signal_stream.h"

#include <gtest/gtest.h>

#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

TEST(SignalStream, DoesNotDependOnDrawingAhead) {
    const TargetSpace target = targets::target_of(shapes::sphere_cloud(500));
    constexpr int kMost = 64;
    SignalStream signals(target, 7, kMost);
    Random same(7);
    Random sizes(1);
    for (int round = 0; round < 2000; ++round) {
        const int count = 1 + static_cast<int>(sizes.below(kMost));
        const vcg::Point3f* taken = signals.take(count);
        for (int i = 0; i < count; ++i) ASSERT_EQ(taken[i], target.sample(same)) << round;
        if (sizes.below(2) == 0) signals.draw_ahead(1 + static_cast<int>(sizes.below(kMost)));
    }
}

}  // namespace
}  // namespace neuralmesh
