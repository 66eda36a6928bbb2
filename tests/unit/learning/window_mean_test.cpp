// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The mean of a window against the sum over a queue.
#include "vcg_core/learning/window_mean.h"

#include <gtest/gtest.h>

#include <deque>
#include <numeric>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

TEST(WindowMean, IsTheMeanOfTheLastValues) {
    for (const int window : {1, 2, 7, 1000}) {
        Random random(3);
        WindowMean mean(window);
        EXPECT_EQ(mean.mean(), 0);
        std::deque<double> last;
        for (int i = 0; i < 5000; ++i) {
            last.push_back(static_cast<double>(random.unit()));
            if (static_cast<int>(last.size()) > window) last.pop_front();
            mean.add(last.back());
            ASSERT_NEAR(mean.mean(), std::accumulate(last.begin(), last.end(), 0.0) / double(last.size()),
                        1e-12);
        }
    }
}

TEST(WindowMean, ForgetsLargeValuesWithinTwoRounds) {
    WindowMean mean(100);
    for (int i = 0; i < 150; ++i) mean.add(2);
    for (int i = 0; i < 200; ++i) mean.add(1e-17);
    EXPECT_NEAR(mean.mean(), 1e-17, 1e-17 * 100 * 0x1p-53);  // a hundred roundings
    for (int i = 0; i < 200; ++i) mean.add(0);
    EXPECT_EQ(mean.mean(), 0);
}

TEST(WindowMean, IsNeverNegative) {
    WindowMean mean(10);
    Random random(9);
    for (int i = 0; i < 100000; ++i) {
        mean.add(random.below(5) == 0 ? static_cast<double>(random.unit()) * 2 : 1e-19);
        ASSERT_GE(mean.mean(), 0) << "after " << i;
    }
}

}  // namespace
}  // namespace neuralmesh
