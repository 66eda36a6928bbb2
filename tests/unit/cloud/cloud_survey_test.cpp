// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What the survey of a cloud's spacing tells: outliers, and the areas that points stand for.
#include <stdexcept>

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/cloud/outlier_removal.h"

namespace neuralmesh::cloud_survey_test {

using FloatCloud = std::vector<vcg::Point3f>;
using shapes::in_float;

// Which points of a cloud are outliers, on shapes where it is known.

std::vector<std::uint8_t> outliers_of(const FloatCloud& cloud, int threads) {
    return find_outliers(CloudSurvey(cloud, threads), threads);
}

constexpr double kTau = 6.283185307179586;

vcg::Point3f direction(Random& random) {
    const double z = 2 * shapes::unit(random) - 1, a = kTau * shapes::unit(random);
    const double r = std::sqrt(1 - z * z);
    return {static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)), static_cast<float>(z)};
}

/// Points of a sphere of radius .3 around the origin.
FloatCloud sphere(std::size_t count, Random& random) {
    FloatCloud cloud;
    for (std::size_t i = 0; i < count; ++i) cloud.push_back(direction(random) * 0.3F);
    return cloud;
}

vcg::Point3f anywhere(Random& random) { return vcg::Point3f::Construct(shapes::in_cube(random) * 0.5); }

std::size_t count_of(const std::vector<std::uint8_t>& out, std::size_t begin, std::size_t end) {
    if (out.empty()) return 0;
    return static_cast<std::size_t>(std::count(out.begin() + static_cast<std::ptrdiff_t>(begin),
                                               out.begin() + static_cast<std::ptrdiff_t>(end), 1));
}

/// A sphere of \p count points, then \p more points: how many of them are found; no point of the sphere may
/// be.
std::size_t found_beside_a_sphere(const FloatCloud& more, Random& random, std::size_t count = 20000) {
    FloatCloud cloud = sphere(count, random);
    cloud.insert(cloud.end(), more.begin(), more.end());
    const std::vector<std::uint8_t> out = outliers_of(cloud, 1);
    EXPECT_LE(count_of(out, 0, count), count / 1000) << "at most .1 % of the surface";
    return count_of(out, count, cloud.size());
}

TEST(OutlierRemoval, FindsNoneInCleanClouds) {
    Random random(1);
    EXPECT_TRUE(outliers_of(sphere(20000, random), 1).empty());
    EXPECT_TRUE(outliers_of(sphere(kFewestForOutliers, random), 1).empty());
    EXPECT_TRUE(outliers_of(FloatCloud(2), 1).empty());
    FloatCloud noisy = sphere(20000, random);
    for (vcg::Point3f& p : noisy) p *= 1 + 0.02F * (random.unit() + random.unit() - 1);
    EXPECT_LE(count_of(outliers_of(noisy, 1), 0, noisy.size()), 20u) << "noise of several spacings";
}

TEST(OutlierRemoval, FindsScatteredPointsFarFromTheSurface) {
    Random random(2);
    for (const std::size_t count : {20u, 200u, 2000u}) {
        FloatCloud far;
        while (far.size() < count) {
            const vcg::Point3f p = anywhere(random);
            if (std::abs(p.Norm() - 0.3F) > 0.03F) far.push_back(p);  // more than five spacings
        }
        EXPECT_GE(found_beside_a_sphere(far, random), count * 95 / 100) << count;
    }
}

TEST(OutlierRemoval, KeepsANoisySurfaceBesideManyOutliers) {
    Random random(12);
    FloatCloud cloud = sphere(20000, random);
    for (vcg::Point3f& p : cloud) {
        const float noise = random.unit() + random.unit() + random.unit() + random.unit() - 2;
        p *= 1 + 0.02F * noise;  // standard deviation .0035, half a spacing
    }
    for (int i = 0; i < 1000; ++i) cloud.push_back(anywhere(random));
    const std::vector<std::uint8_t> out = outliers_of(cloud, 1);
    EXPECT_LE(count_of(out, 0, 20000), 20u) << "at most .1 %";
    EXPECT_GE(count_of(out, 20000, cloud.size()), 800u);
}

TEST(OutlierRemoval, FindsPairsAndClumps) {
    Random random(3);
    FloatCloud pairs;
    FloatCloud clumps;
    while (clumps.size() < 20 * 30) {
        const vcg::Point3f centre = anywhere(random);
        if (std::abs(centre.Norm() - 0.3F) < 0.06F) continue;
        pairs.push_back(centre);
        pairs.push_back(centre + direction(random) * 0.001F);
        for (int i = 0; i < 30; ++i)
            clumps.push_back(centre + direction(random) * (0.01F * std::cbrt(random.unit())));
    }
    EXPECT_GE(found_beside_a_sphere(pairs, random), pairs.size() * 95 / 100);
    EXPECT_GE(found_beside_a_sphere(clumps, random), clumps.size() * 9 / 10) << "two may touch";
}

// Clumps as dense as the surface, three of their spacings (.006) off it: whether the surface and a clump
// share neighbouring octree cells is chance, at any place and size of the cells.
TEST(OutlierRemoval, FindsClumpsThreeSpacingsOffTheSurface) {
    Random random(12);
    constexpr float kRadius = 0.008F, kGap = 0.019F;
    FloatCloud clumps;
    for (int clump = 0; clump < 16; ++clump) {
        const float height = (static_cast<float>(clump) - 7.5F) / 8, turn = 2.4F * static_cast<float>(clump);
        const float ring = std::sqrt(1 - height * height);
        const vcg::Point3f off(ring * std::cos(turn), ring * std::sin(turn), height);
        const vcg::Point3f centre = off * (0.3F + kGap + kRadius);
        for (int i = 0; i < 40; ++i)
            clumps.push_back(centre + direction(random) * (kRadius * std::cbrt(random.unit())));
    }
    EXPECT_GE(found_beside_a_sphere(clumps, random, 100000), clumps.size() * 98 / 100);
}

TEST(OutlierRemoval, KeepsAWire) {
    Random random(4);
    FloatCloud wire;  // its points are three spacings of the sphere apart
    for (int i = 0; i < 60; ++i) wire.emplace_back(0.3F + 0.008F * static_cast<float>(i), 0.0F, 0.0F);
    EXPECT_LE(found_beside_a_sphere(wire, random), 3u);
}

TEST(OutlierRemoval, KeepsABlade) {
    Random random(5);
    FloatCloud blade;
    for (int i = 0; i < 300; ++i)
        blade.emplace_back(0.3F + 0.4F * random.unit(), 0.05F * random.unit(), 0.0F);
    EXPECT_LE(found_beside_a_sphere(blade, random), 3u);
}

TEST(OutlierRemoval, KeepsASmallBentSheetUnderNoise) {
    // Half a sphere whose noise is as wide as its points are apart.
    Random random(1);
    FloatCloud sheet;
    while (sheet.size() < 900) {
        const vcg::Point3f p =
            direction(random) * (0.05F + 0.005F * static_cast<float>(shapes::signed_unit(random)));
        if (p[2] > 0) sheet.push_back(p + vcg::Point3f(0, 0, 0.4F));
    }
    EXPECT_EQ(found_beside_a_sphere(sheet, random, 100000), 0U);
}

TEST(OutlierRemoval, KeepsTheRowsOfASparseView) {
    Random random(6);
    FloatCloud rows;  // dense along each row, ten times as far from one to the next
    for (int row = 0; row < 8; ++row)
        for (int i = 0; i < 50; ++i)
            rows.emplace_back(0.31F + 0.05F * static_cast<float>(row), 0.005F * static_cast<float>(i - 25),
                              0.0F);
    EXPECT_LE(found_beside_a_sphere(rows, random), 12u);
}

TEST(OutlierRemoval, KeepsAHalfThatIsAThousandTimesSparser) {
    Random random(7);
    FloatCloud cloud;
    int below = 0;
    for (const vcg::Point3f& p : sphere(400000, random))
        if (p[2] >= 0 || ++below % 1000 == 0) cloud.push_back(p);
    const std::vector<std::uint8_t> out = outliers_of(cloud, 1);
    EXPECT_LE(count_of(out, 0, out.size()), 30u) << "of the 200 sparse points";
}

TEST(OutlierRemoval, KeepsTheFarEndOfAFloorSeenFromOnePlace) {
    Random random(8);
    FloatCloud floor;  // a scanner at height 1 over the origin: spacing grows with the square of the distance
    for (int ring = 0; ring < 150; ++ring)
        for (int i = 0; i < 200; ++i) {
            const double down = 1.4 - 0.009 * ring, angle = kTau * (i + shapes::unit(random)) / 200;
            const double r = 0.01 / std::tan(down);
            floor.emplace_back(static_cast<float>(r * std::cos(angle)),
                               static_cast<float>(r * std::sin(angle)), -0.01F);
        }
    const std::vector<std::uint8_t> out = outliers_of(floor, 1);
    EXPECT_LE(count_of(out, 0, out.size()), floor.size() / 1000);
}

TEST(OutlierRemoval, DoesNotDependOnScale) {
    Random random(9);
    FloatCloud cloud = sphere(20000, random);
    for (int i = 0; i < 500; ++i) cloud.push_back(anywhere(random));
    const std::vector<std::uint8_t> one = outliers_of(cloud, 1);
    for (vcg::Point3f& p : cloud) p *= 1024;  // exact
    EXPECT_EQ(outliers_of(cloud, 1), one);
}

TEST(OutlierRemoval, EndsWithWhatItsBeatThrows) {
    const FloatCloud cloud = shapes::in_float(shapes::sphere_cloud(20000));
    const CloudSurvey survey(cloud, 2);
    const auto stop = [] { throw std::runtime_error("stop"); };
    EXPECT_THROW(find_outliers(survey, 2, stop), std::runtime_error);
}

TEST(OutlierRemoval, OneFarPointDoesNotHideTheOthers) {
    Random random(10);
    FloatCloud cloud = sphere(20000, random);
    for (int i = 0; i < 100; ++i) cloud.push_back(direction(random) * (0.05F + 0.15F * random.unit()));
    cloud.emplace_back(1e5F, 0.0F, 0.0F);
    const std::vector<std::uint8_t> out = outliers_of(cloud, 1);
    EXPECT_EQ(count_of(out, 0, 20000), 0u);
    EXPECT_EQ(count_of(out, 20000, cloud.size()), 101u);
}

TEST(OutlierRemoval, CopesWithCoincidingPoints) {
    Random random(11);
    FloatCloud cloud = sphere(5000, random);
    for (int i = 0; i < 400; ++i) cloud.emplace_back(0.3F, 0.0F, 0.0F);
    EXPECT_LE(count_of(outliers_of(cloud, 1), 0, cloud.size()), 5u);
    EXPECT_TRUE(outliers_of(FloatCloud(1000, {1, 1, 1}), 1).empty());
}

// The areas that points stand for, and signals that are even over the surface.

std::vector<float> areas_of(const Cloud& cloud) { return CloudSurvey(in_float(cloud), 1).areas_if_uneven(); }

bool is_uneven(const Cloud& cloud) { return !areas_of(cloud).empty(); }

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
        const CloudSurvey survey(in_float(shapes::uneven_sphere_cloud(50000, ratio)), 1);
        const std::vector<float> areas = survey.areas_if_uneven();
        ASSERT_FALSE(areas.empty());
        double sums[2] = {};
        double counts[2] = {};
        for (NearestPoints::Place i = 0; i < survey.cloud.size(); ++i) {
            const int upper = survey.cloud.point(i)[2] > 0 ? 1 : 0;
            sums[upper] += static_cast<double>(areas[i / CloudSurvey::kRun]);
            ++counts[upper];
        }
        EXPECT_NEAR(sums[1] / counts[1] / (sums[0] / counts[0]), ratio, 0.15 * ratio);
        EXPECT_NEAR((sums[0] + sums[1]) / (counts[0] + counts[1]), 1, 1e-3);
    }
}

TEST(PointAreas, AreBounded) {
    Cloud cloud = shapes::uneven_sphere_cloud(20000, 1000);
    cloud.resize(25000, cloud.front());
    const std::vector<float> areas = areas_of(cloud);
    ASSERT_FALSE(areas.empty());
    const auto [least, most] = std::minmax_element(areas.begin(), areas.end());
    EXPECT_GT(*least, 0);
    EXPECT_LE(*most, 10001 * *least);
}

TEST(PointAreas, OfAFarEndAreAtMostAHundredTimesTheMedian) {
    std::vector<float> sorted = areas_of(shapes::uneven_sphere_cloud(400000, 1000));
    ASSERT_FALSE(sorted.empty());
    std::sort(sorted.begin(), sorted.end());
    const double times = static_cast<double>(sorted.back() / sorted[sorted.size() / 2]);
    EXPECT_NEAR(times, 100, 1);
}

TEST(TargetSpaceEvenly, EveryPointIsDrawnInProportionToItsWeight) {
    const TargetSpace given = target_of(shapes::uneven_sphere_cloud(3000, 20));
    const auto even = given.evenly(CloudSurvey(given.positions(), 1));
    ASSERT_TRUE(even.has_value());
    EXPECT_TRUE(even->is_weighted());
    EXPECT_FALSE(given.is_weighted());
    EXPECT_EQ(even->frame().centre, given.frame().centre);
    EXPECT_EQ(even->frame().diagonal, given.frame().diagonal);
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

}  // namespace neuralmesh::cloud_survey_test
