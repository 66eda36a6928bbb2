// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/face_signals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/unit/support/nearest_face.h"
#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

using referee::nearest_face;
using targets::network_in_frame;
using targets::target_of;

/// The points of the unit sphere that are lower than \p top.
shapes::Cloud lower_sphere(int count, double top) {
    shapes::Cloud cloud;
    for (const vcg::Point3d& p : shapes::sphere_cloud(count))
        if (p[2] < top) cloud.push_back(p);
    cloud.emplace_back(0, 0, 1);  // so that the frame is that of the whole sphere
    return cloud;
}

TEST(FairSample, HasEveryPointOfACloudOnceAtMost) {
    const TargetSpace target = target_of(shapes::sphere_cloud(1000));
    Random random(1);
    std::vector<Vector3> signals = fair_sample(target, 700, random);
    ASSERT_EQ(signals.size(), 700U);
    const auto before = [](const Vector3& a, const Vector3& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    std::sort(signals.begin(), signals.end(), before);
    EXPECT_TRUE(std::adjacent_find(signals.begin(), signals.end()) == signals.end());
    EXPECT_EQ(fair_sample(target, 1001, random).size(), 1000U);
    EXPECT_EQ(fair_sample(target_of(shapes::cube()), 1001, random).size(), 1001U) << "drawn from faces";
}

TEST(FaceSignals, GiveEverySignalToTheNearestFace) {
    const TargetSpace target = target_of(shapes::sphere_cloud(500, 0.05));
    const Network network = network_in_frame(target, shapes::icosphere(2));
    const Surface surface(network);
    Random random(1);
    const std::vector<Vector3> signals = fair_sample(target, 1000, random);
    ASSERT_EQ(signals.size(), 500U);
    ThreadTeam team(1);
    const FaceSignals support = face_signals(network, surface, signals, team);
    int sum = 0;
    for (int f = 0; f < surface.face_count(); ++f) {
        EXPECT_EQ(support.of(f).size(), support.wins[f]);
        sum += support.wins[f];
        for (const FaceSignals::Assigned& s : support.of(f)) {
            EXPECT_EQ(s.squared_distance,
                      nearest_face(s.point, surface.positions, surface.faces).foot.squared_distance);
            EXPECT_EQ(s.squared_distance, foot_on_triangle(s.point, surface.corner(f, 0),
                                                           surface.corner(f, 1), surface.corner(f, 2))
                                              .squared_distance);
        }
    }
    EXPECT_EQ(sum, 500);
}

TEST(FaceSignals, ExpectAsManyAsThereAreWhereThePointsAreEven) {
    const TargetSpace target = target_of(shapes::sphere_cloud(50000));
    const Network network = network_in_frame(target, shapes::icosphere(2));
    const Surface surface(network);
    Random random(1);
    ThreadTeam team(1);
    const FaceSignals support = face_signals(network, surface, fair_sample(target, 100000, random), team);
    for (int f = 0; f < surface.face_count(); ++f) {
        EXPECT_NEAR(support.expected[f], 50000.0F * 1 / 320, 50);
        EXPECT_FALSE(support.lacks_support(f));
    }
}

TEST(FaceSignals, AMembraneLacksSupportHoweverWideItIs) {
    const TargetSpace target = target_of(lower_sphere(20000, -0.2));
    const Network network = network_in_frame(target, shapes::icosphere(3));
    const Surface surface(network);
    Random random(1);
    ThreadTeam team(1);
    const FaceSignals support = face_signals(network, surface, fair_sample(target, 100000, random), team);
    int lacking = 0;
    for (int f = 0; f < surface.face_count(); ++f) {
        const float z = (surface.corner(f, 0) + surface.corner(f, 1) + surface.corner(f, 2))[2] / 3;
        const float unit = surface.corner(f, 0).norm();
        if (z < -0.3F * unit) {
            EXPECT_FALSE(support.lacks_support(f));
        }
        if (z > 0.1F * unit) lacking += support.lacks_support(f) ? 1 : 0;
    }
    // All but the face at the single point on top.
    EXPECT_GT(lacking, 500);
}

}  // namespace
}  // namespace neuralmesh
