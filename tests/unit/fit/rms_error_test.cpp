// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The reported distance of the points from the mesh: exact for small clouds, of random points for large ones.
#include "vcg_core/fit/point_errors.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

// One of 100 points lies 2 away from the sphere: random points would count it 0, 1, 2 times or more.
TEST(RmsError, IsThatOfAllPointsOfASmallCloud) {
    shapes::Cloud cloud = shapes::sphere_cloud(100);
    cloud[50] = cloud[50] * 3;
    const TargetSpace target = targets::target_of(cloud);
    const Network sphere = targets::network_in_frame(target, shapes::icosphere(5));
    const double unit = 1 / target.frame().diagonal;
    ThreadTeam team(1), three(3);
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        Random random(seed);
        EXPECT_NEAR(rms_distance(target, sphere, 100, random, team), 0.2 * unit, 2e-4 * unit);
    }
    Random one(1), other(2), again(2);
    EXPECT_NE(rms_distance(target, sphere, 99, one, team), rms_distance(target, sphere, 99, other, team));
    Random same(2);
    EXPECT_EQ(rms_distance(target, sphere, 99, again, team), rms_distance(target, sphere, 99, same, three));
}

}  // namespace
}  // namespace neuralmesh
