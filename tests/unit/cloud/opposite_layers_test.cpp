// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Thin walls are told from single layers.
#include "vcg_core/cloud/opposite_layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

constexpr int kPointsOfWall = 20000;

double share_of(const shapes::Cloud& cloud) {
    std::vector<vcg::Point3f> points;
    for (const vcg::Point3d& p : cloud) points.push_back(vcg::Point3f::Construct(p));
    ThreadTeam team(1);
    Surveys surveys(points, 1);
    return share_on_thin_walls(layer_places(surveys.points(), team), surveys);
}

/// A sphere of \p kPointsOfWall points and another one within it, \p spacings spacings of the points away.
shapes::Cloud two_spheres(double spacings) {
    const double spacing = std::sqrt(4 * M_PI / kPointsOfWall);
    shapes::Cloud cloud = shapes::sphere_cloud(kPointsOfWall);
    // In another order, so that no point lies above its like.
    for (const vcg::Point3d& p : shapes::sphere_cloud(kPointsOfWall))
        cloud.emplace_back(vcg::Point3d(-p[1], p[2], p[0]) * (1 - spacings * spacing));
    return cloud;
}

TEST(OppositeLayers, AreFoundFromThreeSpacingsOn) {
    for (const double spacings : {3.0, 5.0, 6.0}) EXPECT_GT(share_of(two_spheres(spacings)), 0.8) << spacings;
}

TEST(OppositeLayers, AreNotFoundWhereTheyAreFarOrOne) {
    EXPECT_LT(share_of(two_spheres(20)), 0.02);
    EXPECT_LT(share_of(two_spheres(0.5)), 0.1);
}

TEST(OppositeLayers, OfOneLayerAreNone) {
    EXPECT_LT(share_of(shapes::sphere_cloud(kPointsOfWall)), 0.01);
    EXPECT_LT(share_of(shapes::plane_cloud(kPointsOfWall)), 0.01);
    const double spacing = std::sqrt(4 * M_PI / kPointsOfWall);
    for (const double noise : {0.5, 1.0, 2.0})
        EXPECT_LT(share_of(shapes::sphere_cloud(kPointsOfWall, noise * spacing)), 0.2) << noise;
}

TEST(OppositeLayers, OfDepthsInStepsAreNone) {
    // A slanting plane with noise, whose heights are rounded to multiples of three spacings. Of the places
    // .42 and .49 have the next step above or below them.
    Random random(1);
    const double spacing = 1 / std::sqrt(kPointsOfWall), step = 3 * spacing;
    for (const double noise : {2.0, 3.0}) {
        shapes::Cloud cloud = shapes::plane_cloud(kPointsOfWall);
        for (vcg::Point3d& p : cloud)
            p[2] = step * std::round((0.1 * p[0] + noise * spacing * shapes::signed_unit(random)) / step);
        EXPECT_LT(share_of(cloud), 0.05) << noise;
    }
}

TEST(OppositeLayers, OfCloudsWithoutASurfaceAreNone) {
    EXPECT_EQ(share_of(shapes::Cloud(100, vcg::Point3d(1, 2, 3))), 0);
    EXPECT_EQ(share_of(shapes::sphere_cloud(5)), 0);
}

}  // namespace
}  // namespace neuralmesh
