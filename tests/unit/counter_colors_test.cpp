// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Vertex colours that show the feature measure: light where it is small, the ends at two percentiles.
#include "vcg_core/output/vertex_colors.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace neuralmesh {
namespace {

/// 0, 1, ..., 100: each value is its own percentile.
std::vector<float> hundred_and_one() {
    std::vector<float> counters(101);
    std::iota(counters.begin(), counters.end(), 0.0F);
    return counters;
}

/// Relative luminance by ITU-R BT.709, without its transfer function.
double luminance(const Color& c) { return (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255; }

TEST(CounterColors, GetDarkerAsCountersGrow) {
    const std::vector<Color> colors = counter_colors(hundred_and_one());
    ASSERT_EQ(colors.size(), 101U);
    for (std::size_t i = 3; i <= 98; ++i) EXPECT_LT(luminance(colors[i]), luminance(colors[i - 1])) << i;
}

TEST(CounterColors, AreReadableOnAShadedSurface) {
    const std::vector<Color> colors = counter_colors(hundred_and_one());
    EXPECT_GT(luminance(colors.front()), 0.9);
    EXPECT_GT(luminance(colors.back()), 0.2);
}

TEST(CounterColors, EndAtThePercentiles) {
    std::vector<float> counters = hundred_and_one();
    const std::vector<Color> colors = counter_colors(counters);
    EXPECT_EQ(colors[0], colors[2]);
    EXPECT_NE(colors[2], colors[3]);
    EXPECT_NE(colors[97], colors[98]);
    EXPECT_EQ(colors[98], colors[100]);
    counters[100] = 1e30F;
    EXPECT_EQ(counter_colors(counters), colors) << "one extreme counter changed the others' colours";
}

TEST(CounterColors, AreLightIfAllCountersAreEqual) {
    EXPECT_TRUE(counter_colors({}).empty());
    const std::vector<Color> colors = counter_colors({5, 5, 5});
    EXPECT_EQ(colors, std::vector<Color>(3, counter_colors(hundred_and_one()).front()));
}

}  // namespace
}  // namespace neuralmesh
