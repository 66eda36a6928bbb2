// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The nearest point of a triangle against a dense sampling of the triangle.
#include "vcg_core/mesh/triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/unit/support/shapes.h"
#include "vcg_core/mesh/triangle_lanes.h"

namespace neuralmesh {
namespace {

Vector3 corner_in_cube(Random& random) { return to_eigen(vcg::Point3f::Construct(shapes::in_cube(random))); }

/// The least squared distance of \p p from a lattice of points on the triangle.
double sampled_squared_distance(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c,
                                int steps) {
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
            const float s = static_cast<float>(i) / static_cast<float>(steps);
            const float t = static_cast<float>(j) / static_cast<float>(steps);
            const Vector3 q = a + s * (b - a) + t * (c - a);
            least = std::min(least, static_cast<double>((p - q).squaredNorm()));
        }
    return least;
}

void expect_foot(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c, double tolerance) {
    constexpr int kSteps = 100;
    const Foot foot = foot_on_triangle(p, a, b, c);
    const auto& w = foot.weights;
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-5);
    for (float weight : w) EXPECT_GE(weight, -1e-6F);
    const Vector3 q = w[0] * a + w[1] * b + w[2] * c;
    EXPECT_NEAR((p - q).norm(), std::sqrt(foot.squared_distance), tolerance);
    const double sampled = std::sqrt(sampled_squared_distance(p, a, b, c, kSteps));
    const double spacing =
        static_cast<double>(std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()})) / kSteps;
    const double found = std::sqrt(static_cast<double>(foot.squared_distance));
    EXPECT_LE(found, sampled + tolerance);
    EXPECT_GE(found, sampled - spacing);
}

TEST(FootOnTriangle, IsTheNearestOfManySamples) {
    Random random(1);
    for (int i = 0; i < 500; ++i)
        expect_foot(2 * corner_in_cube(random), corner_in_cube(random), corner_in_cube(random),
                    corner_in_cube(random), 1e-5);
}

// The corners of a needle lie on a line only up to rounding.
TEST(FootOnTriangle, IsRightOnDegenerateTriangles) {
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        const Vector3 a = corner_in_cube(random);
        const Vector3 b = corner_in_cube(random);
        expect_foot(2 * corner_in_cube(random), a, b, 0.25F * a + 0.75F * b, 1e-3);
        expect_foot(2 * corner_in_cube(random), a, b, b, 1e-3);
        expect_foot(2 * corner_in_cube(random), a, a, a, 1e-5);
    }
}

// Callers tell the inside from the border by weights of exactly 0.
TEST(FootOnTriangle, GivesCornersWithoutAPartTheWeightZero) {
    const Vector3 a(0, 0, 0);
    const Vector3 b(1, 0, 0);
    const Vector3 c(0, 1, 0);
    EXPECT_EQ(foot_on_triangle(Vector3(-1, -1, 1), a, b, c).weights, (std::array<float, 3>{1, 0, 0}));
    EXPECT_EQ(foot_on_triangle(Vector3(2, -1, 1), a, b, c).weights, (std::array<float, 3>{0, 1, 0}));
    EXPECT_EQ(foot_on_triangle(Vector3(0.5F, -1, 0), a, b, c).weights[2], 0);
    EXPECT_EQ(foot_on_triangle(Vector3(-1, 0.5F, 0), a, b, c).weights[1], 0);
    EXPECT_EQ(foot_on_triangle(Vector3(1, 1, 0), a, b, c).weights[0], 0);
}

/// Of a lattice of few places, so that triangles may be degenerate, and points lie on borders of regions.
Vector3 on_lattice(Random& random) {
    const auto coordinate = [&] { return 0.25F * static_cast<float>(random.below(5)) - 0.5F; };
    const float x = coordinate(), y = coordinate();
    return {x, y, coordinate()};
}

TEST(SquaredDistanceToTriangle, HasTheBitsOfTheFoot) {
    Random random(11);
    for (int run = 0; run < 20000; ++run) {
        const auto place = [&] { return run % 2 == 0 ? on_lattice(random) : corner_in_cube(random); };
        const Vector3 ab = place(), ac = place();
        std::array<Vector3, 8> points;
        EightVectors lanes;
        for (std::size_t i = 0; i < points.size(); ++i) {
            points[i] = place();
            lanes.x[i] = points[i][0];
            lanes.y[i] = points[i][1];
            lanes.z[i] = points[i][2];
        }
        Eight squared;
        squared_distance_to_triangle(ab, ac, lanes, squared);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const float expected = foot_on_triangle(ab, ac, points[i]).squared_distance;
            ASSERT_TRUE(squared[i] == expected || (std::isnan(squared[i]) && std::isnan(expected)))
                << squared[i] << " for " << expected << ", run " << run;
        }
    }
}

/// 1 + 1 is even in the last place of 2^24 and 2^53; 1 alone is rounded off.
TEST(Triangle, AddsTheLastTwoOfThreeTermsFirstOnEveryProcessor) {
    const Eigen::Vector3f floats(0x1p24F, 1, 1);
    EXPECT_EQ(floats.dot(Eigen::Vector3f::Ones()), 0x1p24F + 2);
    const Eigen::Vector3d doubles(0x1p53, 1, 1);
    EXPECT_EQ(doubles.dot(Eigen::Vector3d::Ones()), 0x1p53 + 2);
}

}  // namespace
}  // namespace neuralmesh
