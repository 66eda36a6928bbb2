// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The stream is what the target space gives, however far it is drawn ahead.
#include "vcg_core/target/signal_stream.h"

#include <gtest/gtest.h>

#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

TEST(SignalStream, ComeInTheOrderOfTheRandomNumbers) {
    const shapes::Cloud cloud = shapes::sphere_cloud(500);
    const TargetSpace target = TargetSpace::points(cloud.size(), [&](std::size_t i) { return cloud[i]; });
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
