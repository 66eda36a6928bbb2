// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/outliers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

std::vector<Point3f> sphere(int count, float radius, const Point3f& centre, std::uint64_t seed) {
    std::vector<Point3f> points;
    for (const vcg::Point3d& p : shapes::sphere_cloud(count, 0, seed))
        points.push_back(centre + Point3f::Construct(p) * radius);
    return points;
}

void append(std::vector<Point3f>& points, const std::vector<Point3f>& more) {
    points.insert(points.end(), more.begin(), more.end());
}

/// A sphere of radius 0.5 with 20,000 points, which is in one piece at level 4, and \p others.
struct Examined {
    explicit Examined(const std::vector<Point3f>& others)
        : points(sphere(20000, 0.5F, {0, 0, 0}, 1)),
          surface_points(points.size()),
          region(with(others, points)),
          solid(solid_of(region.lattice, region.clearance, region.counts, kLevel, region.min_points).nodes) {}

    /// The outliers among the others; empty if outliers_of() is.
    std::vector<int> outliers() const {
        const std::vector<std::uint8_t> all = outliers_of(points, region, solid, kLevel);
        if (all.empty()) return {};
        EXPECT_EQ(all.size(), points.size());
        const auto others = all.begin() + static_cast<std::ptrdiff_t>(surface_points);
        EXPECT_EQ(std::count(all.begin(), others, 0), static_cast<std::ptrdiff_t>(surface_points));
        return {others, all.end()};
    }

    static constexpr int kLevel = 4;
    std::vector<Point3f> points;
    std::size_t surface_points;
    Region region;
    NodeSet solid;

private:
    static Region with(const std::vector<Point3f>& others, std::vector<Point3f>& points) {
        append(points, others);
        const vcg::Box3f box(Point3f(-1, -1, -1), Point3f(1, 1, 1));
        return examine(points, box, 0.04F);
    }
};

TEST(Outliers, OfASurfaceAloneThereAreNone) { EXPECT_TRUE(Examined({}).outliers().empty()); }

TEST(Outliers, AreIsolatedPointsOutside) {
    EXPECT_EQ(Examined({{0.8F, 0, 0}, {0, 0, -0.9F}}).outliers(), (std::vector<int>{1, 1}));
}

TEST(Outliers, ArePointsOutsideTheLattice) {
    EXPECT_EQ(Examined({{3, 0, 0}, {0, -1e20F, 0}}).outliers(), (std::vector<int>{1, 1}));
}

TEST(Outliers, ArePointsDeepInside) {
    EXPECT_EQ(Examined({{0, 0, 0}, {0.2F, 0, 0}}).outliers(), (std::vector<int>{1, 1}));
}

TEST(Outliers, AreNotPointsCloseToTheSurface) {
    EXPECT_TRUE(Examined({{0.52F, 0, 0}, {0, 0.48F, 0}}).outliers().empty());
    // Each is judged on its own: of these the second one is an outlier.
    EXPECT_EQ(Examined({{0.52F, 0, 0}, {0.8F, 0, 0}}).outliers(), (std::vector<int>{0, 1}));
}

TEST(Outliers, AreGroupsSmallerThanAComponent) {
    // 1 % of 20,000 points are 200.
    EXPECT_EQ(Examined(sphere(100, 0.05F, {0.8F, 0, 0}, 2)).outliers(), std::vector<int>(100, 1));
    EXPECT_TRUE(Examined(sphere(400, 0.05F, {0.8F, 0, 0}, 2)).outliers().empty());
}

}  // namespace
}  // namespace neuralmesh
