// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/depth_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/support/depth_camera.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

std::vector<Point3f> rounded_to_float(const shapes::Cloud& cloud) {
    std::vector<Point3f> points;
    for (const vcg::Point3d& p : cloud) points.push_back(Point3f::Construct(p));
    return points;
}

/// Along z, of the first point.
float deviation(const std::vector<Point3f>& points, float spacing) {
    return DepthSteps(NearestPoints(points)).deviation(points.front(), {0, 0, 1}, spacing);
}

TEST(DepthSteps, GrowWithTheDepth) {
    const std::vector<Point3f> points = rounded_to_float(sensors::frame_of_steps(240));
    const DepthSteps steps{NearestPoints(points)};
    constexpr float kSpacing = 0.012F;
    int none = 0, all = 0;
    for (std::size_t i = 0; i < points.size(); i += 97) {
        const double z = static_cast<double>(points[i][2]), step = z * z / 351;
        const float found = steps.deviation(points[i], {0, 0, 1}, kSpacing);
        ++all;
        // The first and the last value, and the row in the middle, whose y are all 0.
        if (found == 0 && ++none > 0) continue;
        // Of points that are dithered between two steps.
        EXPECT_NEAR(static_cast<double>(found) * std::sqrt(6), step, 0.02 * step) << z;
        EXPECT_NEAR(steps.deviation(points[i], {0.8F, 0, 0.6F}, kSpacing) / found, 0.6F, 1e-3F);
        EXPECT_EQ(steps.deviation(points[i], {1, 0, 0}, kSpacing), 0);
        EXPECT_EQ(steps.deviation(points[i], {0, 0, 1}, 0.06F), 0) << "a spacing is longer";
    }
    EXPECT_LT(none, all / 20);
}

TEST(DepthSteps, AreNoneOnGridsOnStairsAndWithoutRounding) {
    std::vector<Point3f> grid, stairs, random;
    Random numbers(1);
    for (int i = 0; i < 40000; ++i) {
        grid.emplace_back(static_cast<float>(i % 200), static_cast<float>(i / 200 % 200),
                          std::floor(0.3F * static_cast<float>(i % 200)));
        stairs.emplace_back(numbers.unit(), numbers.unit(), static_cast<float>(i % 10));
        random.emplace_back(numbers.unit(), numbers.unit(), numbers.unit());
    }
    EXPECT_EQ(deviation(grid, 1), 0);
    EXPECT_EQ(deviation(stairs, 0.01F), 0);
    EXPECT_EQ(deviation(random, 0.01F), 0);
}

}  // namespace
}  // namespace neuralmesh
