// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Two virtual sensors: a depth camera before a ball and a wall, and an aerial scanner over ground with trees.
#pragma once

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh::sensors {

using vcg::Point3d;

constexpr double kWall = 3;  ///< metres before the camera, at the origin, which looks along z
inline const Point3d kBall(0, 0, 1.6);
constexpr double kBallRadius = 0.35;

/// How far the ray \p way of length 1 gets.
inline double depth_along(const Point3d& way) {
    const double across = way * kBall, squared = across * across - kBall * kBall + kBallRadius * kBallRadius;
    return squared > 0 ? across - std::sqrt(squared) : kWall / way[2];
}

/// A frame of \p width x 3/4 \p width pixels: noise along the ray that grows with the squared depth (Nguyen,
/// Izadi, Lovell, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and Tracking", 2012), and
/// flying points between the depths at the edge of the ball.
inline Cloud depth_frame(int width, unsigned seed = 1) {
    Random random(seed);
    Cloud cloud;
    double last = 0;
    for (int v = 0; v < width * 3 / 4; ++v)
        for (int u = 0; u < width; ++u) {
            const double scale = 1.1 / width;
            const Point3d way =
                Point3d(scale * (u - width / 2.0), scale * (v - width * 3 / 8.0), 1).Normalize();
            const double depth = depth_along(way),
                         deviation = 0.0012 + 0.0019 * (depth - 0.4) * (depth - 0.4);
            double measured = depth + deviation * shapes::normal(random);
            if (u > 0 && std::abs(depth - last) > 0.1 && random.below(3) == 0)
                measured = last + (depth - last) * shapes::unit(random);
            last = depth;
            cloud.push_back(way * measured);
        }
    return cloud;
}

/// The angle, in degrees, between \p n, of length 1 and to either side, and the normal of the ball or the
/// wall, whichever is nearer to \p p.
inline double angle_to_scene(const Point3d& p, const Point3d& n) {
    const Point3d from_ball = p - kBall;
    const bool ball = std::abs(from_ball.Norm() - kBallRadius) < std::abs(p[2] - kWall);
    const Point3d truth = ball ? from_ball / from_ball.Norm() : Point3d(0, 0, 1);
    return std::acos(std::min(1.0, std::abs(truth * n))) * 180 / shapes::kPi;
}

/// What a camera of structured light measures instead of the depth \p z: an eighth of a pixel of disparity
/// (base 75 mm, focus 585 pixels). Its steps are 26 mm long at 3 m.
inline double stepped_depth(double z) {
    constexpr double kSteps = 8 * 0.075 * 585;
    return kSteps / std::round(kSteps / z);
}

/// A frame of \p width x 3/4 \p width pixels of the wall z = 3 + x / 10 + y / 5. The noise is a fifth of a
/// step, so that the points lie on terraces.
inline Cloud frame_of_steps(int width, unsigned seed = 1) {
    Random random(seed);
    Cloud cloud;
    for (int v = 0; v < width * 3 / 4; ++v)
        for (int u = 0; u < width; ++u) {
            const double x = 1.1 * (u - width / 2.0) / width, y = 1.1 * (v - width * 3 / 8.0) / width;
            const double depth = kWall / (1 - x / 10 - y / 5), noise = 0.005 * shapes::normal(random);
            cloud.push_back(Point3d(x, y, 1) * stepped_depth(depth + noise));
        }
    return cloud;
}
inline const Point3d kNormalOfSteps = Point3d(-0.1, -0.2, 1) / std::sqrt(1.05);

constexpr double kTree = 3;  ///< height over the ground at which the crowns of the trees have their middle

/// Hills of 40 x 40 with \p trees round crowns, whose returns fill them, and ground below.
inline Cloud aerial_scan(int points, int trees, unsigned seed = 1) {
    Random random(seed);
    const auto ground = [](double x, double y) { return std::sin(x / 6) + std::cos(y / 5); };
    Cloud cloud;
    for (int i = 0; i < points; ++i) {
        const double x = 20 * shapes::signed_unit(random), y = 20 * shapes::signed_unit(random);
        cloud.emplace_back(x, y, ground(x, y) + 0.02 * shapes::normal(random));
    }
    for (int i = 0; i < trees; ++i) {
        const double x = 16 * shapes::signed_unit(random), y = 16 * shapes::signed_unit(random);
        for (int k = 0; k < 150; ++k)
            cloud.push_back(Point3d(x, y, ground(x, y) + kTree) + shapes::in_ball(random) * 1.5);
    }
    return cloud;
}

}  // namespace neuralmesh::sensors
