// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The place of the camera of one frame, found from its points; none where there was no single camera.
#include "vcg_core/start/sensor_place.h"

#include <gtest/gtest.h>

#include "tests/unit/support/depth_camera.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;
using vcg::Point3d;
using vcg::Point3f;

/// A frame whose camera stands at \p camera and looks along x.
Cloud frame_from(const Point3d& camera, unsigned seed) {
    Cloud cloud = sensors::depth_frame(200, seed);
    for (Point3d& p : cloud) p = camera + Point3d(p[2], p[0], p[1]);
    return cloud;
}

std::optional<Point3f> found(const Cloud& cloud) {
    std::vector<Point3f> points;
    for (const Point3d& p : cloud) points.push_back(Point3f::Construct(p));
    Surveys surveys(points, 1);
    return sensor_place(surveys.points().cloud, surveys.surface().places());
}

TEST(SensorPlace, IsThatOfTheCamera) {
    for (const unsigned seed : {1U, 2U, 3U})
        for (const Point3d& camera : {Point3d(0, 0, 0), Point3d(-2, 3, 1), Point3d(20, 4, -7)}) {
            const std::optional<Point3f> place = found(frame_from(camera, seed));
            ASSERT_TRUE(place) << seed;
            EXPECT_LT((Point3d::Construct(*place) - camera).Norm(), 0.4) << seed;  // the scene is 4 wide
        }
}

TEST(SensorPlace, IsNoneForTwoCameras) {
    Cloud cloud = frame_from({0, 0, 0}, 1);
    for (const Point3d& p : sensors::depth_frame(200, 2)) cloud.emplace_back(6 - p[2], p[0], p[1]);
    EXPECT_FALSE(found(cloud));
}

TEST(SensorPlace, IsNoneForEvenPoints) {
    EXPECT_FALSE(found(shapes::plane_cloud(20000)));
    EXPECT_FALSE(found(sensors::aerial_scan(20000, 10)));
    EXPECT_FALSE(found(shapes::sphere_cloud(20000)));
    EXPECT_FALSE(found(shapes::plane_cloud(30)));
}

}  // namespace
}  // namespace neuralmesh
