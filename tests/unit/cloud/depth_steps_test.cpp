// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/depth_steps.h"

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

/// Steps, and the points around each place on which they are judged.
class Steps {
public:
    explicit Steps(const std::vector<Point3f>& points) : cloud_(points), steps_(cloud_) {}

    /// Of points that are \p spacing apart.
    float deviation(const Point3f& p, const Point3f& normal, float spacing) const {
        constexpr float kSpacings = 3;
        std::vector<Point3f> near;
        cloud_.within(p, kSpacings * spacing, 100, near);
        return steps_.deviation(p, normal, spacing, near);
    }

private:
    NearestPoints cloud_;
    DepthSteps steps_;
};

TEST(DepthSteps, GrowWithTheDepth) {
    const std::vector<Point3f> points = rounded_to_float(sensors::frame_of_steps(240));
    const Steps steps(points);
    constexpr float kSpacing = 0.012F;
    int none = 0, all = 0;
    for (std::size_t i = 0; i < points.size(); i += 97) {
        const double z = static_cast<double>(points[i][2]), step = z * z / 351;
        const float found = steps.deviation(points[i], {0, 0, 1}, kSpacing);
        ++all;
        // The first and the last value, the row in the middle, whose y are all 0, and ends of terraces.
        if (found == 0) {
            ++none;
            continue;
        }
        // Of points that are dithered between two steps.
        EXPECT_NEAR(static_cast<double>(found) * std::sqrt(6), step, 0.02 * step) << z;
        EXPECT_NEAR(steps.deviation(points[i], {0.8F, 0, 0.6F}, kSpacing) / found, 0.6F, 1e-3F);
        EXPECT_EQ(steps.deviation(points[i], {1, 0, 0}, kSpacing), 0);
        EXPECT_EQ(steps.deviation(points[i], {0, 0, 1}, 0.06F), 0) << "a spacing is longer";
    }
    EXPECT_LT(none, all / 10);
}

/// How many of some of the points have steps along z, or along their way from the origin.
int places_with_steps(const std::vector<Point3f>& points, float spacing, bool round) {
    const Steps steps(points);
    int found = 0;
    for (std::size_t i = 0; i < points.size(); i += 97) {
        Point3f normal = round ? points[i] : Point3f(0, 0, 1);
        found += steps.deviation(points[i], normal.Normalize(), spacing) > 0 ? 1 : 0;
    }
    return found;
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
    EXPECT_EQ(places_with_steps(grid, 1, false), 0);
    EXPECT_EQ(places_with_steps(stairs, 0.01F, false), 0);
    EXPECT_EQ(places_with_steps(random, 0.01F, false), 0);
}

TEST(DepthSteps, AreNoneOnTheRingsOfALathe) {
    constexpr int kRings = 100;
    std::vector<Point3f> ball;
    for (int ring = 1; ring < kRings; ++ring) {
        const double polar = shapes::kPi * ring / kRings;
        const int points = static_cast<int>(2 * kRings * std::sin(polar)) + 3;
        for (int i = 0; i < points; ++i) {
            const double turn = 2 * shapes::kPi * i / points;
            ball.push_back(Point3f::Construct(vcg::Point3d(
                std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar))));
        }
    }
    // But for a place or two near the poles.
    EXPECT_LE(places_with_steps(ball, 0.03F, true), 2);
}

}  // namespace
}  // namespace neuralmesh
