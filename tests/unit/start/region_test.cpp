// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

std::vector<Point3f> sphere(int count, double noise = 0) {
    std::vector<Point3f> points;
    for (const vcg::Point3d& p : shapes::sphere_cloud(count, noise)) points.push_back(Point3f::Construct(p));
    return points;
}

/// A square with sides of length 2.
std::vector<Point3f> square(int count) {
    std::vector<Point3f> points;
    for (const vcg::Point3d& p : shapes::plane_cloud(count)) points.push_back(Point3f::Construct(p) * 2);
    return points;
}

Region region_of(const std::vector<Point3f>& points, float step) {
    return examine(points, vcg::Box3f(Point3f(-1, -1, -1), Point3f(1, 1, 1)), step);
}

TEST(Region, KnowsTheShareOfTheSurfaceThatEnclosesNothing) {
    const auto share = [](const std::vector<Point3f>& points) {
        return thin_parts(examine(points, vcg::Box3f(Point3f(-1, -1, -1), Point3f(5, 1, 1)), 0.05F), {})
            .share;
    };
    std::vector<Point3f> points = sphere(20000);
    EXPECT_LT(share(points), 0.001);
    EXPECT_EQ(share(square(10000)), 1);
    // The sphere has an area of 12.6, the square beside it one of 4.
    for (const Point3f& p : square(6000)) points.push_back(p + Point3f(3, 0, 0));
    EXPECT_NEAR(share(points), 4 / 16.6, 0.05);
}

TEST(Region, WideOpeningsAreSealedAndMeasured) {
    std::vector<Point3f> points;
    for (const Point3f& p : sphere(40000))
        if (p[2] < 0.8F) points.push_back(p);
    const Region region = region_of(points, 0.02F);
    EXPECT_TRUE(region.encloses_space);
    EXPECT_EQ(region.clearance[region.lattice.node_of({0, 0, 0})], 0);
    EXPECT_NEAR(region.widest_opening, 0.6, 0.05);  // the hole's radius; its rim is at z = 0.8
}

TEST(Region, TheFringeOfANoisyCloudIsLeftOut) {
    std::vector<Point3f> points = sphere(100000);
    const Region clean = region_of(points, 0.05F);
    EXPECT_EQ(clean.counts, count_points(clean.lattice, points));
    points.emplace_back(0.0F, 0.0F, 1.1F);  // two nodes from the surface
    const Region fringed = region_of(points, 0.05F);
    EXPECT_EQ(fringed.counts, clean.counts);
    EXPECT_NE(fringed.counts, count_points(fringed.lattice, points));
}

}  // namespace
}  // namespace neuralmesh
