// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The areas that points stand for, and signals that are even over the surface.
#include "vcg_core/cloud/point_areas.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;
using targets::target_of;

std::vector<vcg::Point3f> in_float(const Cloud& cloud) {
    std::vector<vcg::Point3f> points;
    for (const vcg::Point3d& p : cloud) points.push_back(vcg::Point3f::Construct(p));
    return points;
}

std::optional<PointAreas> areas_of(const std::vector<vcg::Point3f>& points, int threads = 1) {
    return areas_if_uneven(CloudSurvey(points, threads));
}

bool is_uneven(const Cloud& cloud) { return areas_of(in_float(cloud)).has_value(); }

TEST(PointAreas, EvenCloudsHaveNone) {
    for (const int count : {1100, 2000, 10000, 100000}) {
        EXPECT_FALSE(is_uneven(shapes::sphere_cloud(count))) << count;
        EXPECT_FALSE(is_uneven(shapes::sphere_cloud(count, 0.02))) << count;
        EXPECT_FALSE(is_uneven(shapes::box_cloud(count))) << count;
        EXPECT_FALSE(is_uneven(shapes::plane_cloud(count))) << count;
    }
}

TEST(PointAreas, FewPointsHaveNone) { EXPECT_FALSE(is_uneven(shapes::uneven_sphere_cloud(1000, 40))); }

TEST(PointAreas, OnePlaceHasNone) { EXPECT_FALSE(is_uneven(Cloud(3000, vcg::Point3d(1, 1, 1)))); }

TEST(PointAreas, AreTheRatioOfDensities) {
    for (const int ratio : {5, 10, 30}) {
        const auto areas = areas_of(in_float(shapes::uneven_sphere_cloud(50000, ratio)));
        ASSERT_TRUE(areas.has_value());
        double sums[2] = {};
        double counts[2] = {};
        for (std::size_t i = 0; i < areas->points.size(); ++i) {
            const int upper = areas->points[i][2] > 0 ? 1 : 0;
            sums[upper] += static_cast<double>(areas->of_run[i / PointAreas::kRun]);
            ++counts[upper];
        }
        EXPECT_NEAR(sums[1] / counts[1] / (sums[0] / counts[0]), ratio, 0.15 * ratio);
        EXPECT_NEAR((sums[0] + sums[1]) / (counts[0] + counts[1]), 1, 1e-3);
    }
}

TEST(PointAreas, AreBounded) {
    Cloud cloud = shapes::uneven_sphere_cloud(20000, 1000);
    cloud.resize(25000, cloud.front());
    const auto areas = areas_of(in_float(cloud));
    ASSERT_TRUE(areas.has_value());
    const auto [least, most] = std::minmax_element(areas->of_run.begin(), areas->of_run.end());
    EXPECT_GT(*least, 0);
    EXPECT_LE(*most, 10001 * *least);
}

TEST(PointAreas, OfAFarEndAreAtMostAHundredTimesTheMedian) {
    const auto areas = areas_of(in_float(shapes::uneven_sphere_cloud(400000, 1000)));
    ASSERT_TRUE(areas.has_value());
    std::vector<float> sorted = areas->of_run;
    std::sort(sorted.begin(), sorted.end());
    const double times = static_cast<double>(sorted.back() / sorted[sorted.size() / 2]);
    EXPECT_NEAR(times, 100, 1);
}

TEST(TargetSpaceEvenly, SignalsAreEvenOverTheSurface) {
    const TargetSpace given = target_of(shapes::uneven_sphere_cloud(50000, 20));
    const auto even = given.evenly(CloudSurvey(given.positions(), 1));
    ASSERT_TRUE(even.has_value());
    EXPECT_TRUE(even->is_weighted());
    EXPECT_FALSE(given.is_weighted());
    EXPECT_EQ(even->frame().centre, given.frame().centre);
    EXPECT_EQ(even->frame().diagonal, given.frame().diagonal);
    constexpr int kDraws = 100000;
    Random random(1);
    int upper = 0;
    for (int i = 0; i < kDraws; ++i) upper += even->sample(random)[2] > 0 ? 1 : 0;
    EXPECT_NEAR(upper, 0.5 * kDraws, 0.03 * kDraws);
    upper = 0;
    for (int i = 0; i < kDraws; ++i) upper += given.sample(random)[2] > 0 ? 1 : 0;
    EXPECT_LT(upper, 0.06 * kDraws);
}

TEST(TargetSpaceEvenly, EveryPointIsDrawnInProportionToItsWeight) {
    const TargetSpace given = target_of(shapes::uneven_sphere_cloud(3000, 20));
    const auto even = given.evenly(CloudSurvey(given.positions(), 1));
    ASSERT_TRUE(even.has_value());
    std::vector<std::pair<vcg::Point3f, int>> counts;
    for (const vcg::Point3f& p : even->positions()) counts.emplace_back(p, 0);
    std::sort(counts.begin(), counts.end());
    constexpr int kPerPoint = 400;
    Random random(1);
    for (int i = 0; i < kPerPoint * 3000; ++i)
        ++std::lower_bound(counts.begin(), counts.end(), std::make_pair(even->sample(random), 0))->second;
    for (std::size_t i = 0; i < 3000; ++i) {
        const auto found =
            std::lower_bound(counts.begin(), counts.end(), std::make_pair(even->positions()[i], 0));
        const double expected = kPerPoint * static_cast<double>(even->weight(i));
        EXPECT_NEAR(found->second, expected, 6 * std::sqrt(expected) + 2) << i;
    }
}

}  // namespace
}  // namespace neuralmesh
