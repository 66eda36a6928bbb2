// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Clouds of views that do not quite meet, and clouds of independent noise, on a sphere.
#include "vcg_core/fit/layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/fit/fit_scene.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/fit/fit.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;

constexpr double kEdge = 0.15;  // of icosphere(3) of radius 1
constexpr int kPoints = 20000;

/// Six views of the unit sphere, each from the height of -.3 up, seen along an axis and moved by \p shift.
Cloud views(double shift, double noise) {
    Cloud cloud;
    for (int view = 0; view < 6; ++view) {
        const int axis = view / 2;
        const double sign = view % 2 == 0 ? 1 : -1;
        for (vcg::Point3d p :
             shapes::sphere_cloud(kPoints / 4, noise, static_cast<std::uint64_t>(view) + 1)) {
            if (sign * p[axis] < -0.3) continue;
            p[axis] += (view % 3 - 1) * shift * sign;
            cloud.push_back(p);
        }
    }
    return cloud;
}

float layering_of(const Cloud& cloud) {
    const FitScene scene(referee::network_of(shapes::icosphere(3)), cloud);
    const PerVertex<float> variances = local_variances(scene.network, scene.surface, scene.points);
    return layering(scene.network, scene.surface, variances);
}

TEST(Layers, AreTheViewsThatDoNotMeet) {
    EXPECT_GT(layering_of(views(0.8 * kEdge, 0.05 * kEdge)), 0.9F);
    EXPECT_GT(layering_of(views(0.5 * kEdge, 0.2 * kEdge)), 0.5F);
}

TEST(Layers, AreNeitherNoiseNorCleanPoints) {
    for (const double noise : {0.0, 0.05, 0.2, 0.4}) {
        EXPECT_EQ(layering_of(shapes::sphere_cloud(kPoints, noise * kEdge)), 0) << noise;
        EXPECT_EQ(layering_of(views(0, noise * kEdge)), 0) << noise;
    }
    EXPECT_EQ(layering_of(views(0.05 * kEdge, 0)), 0) << "close to the surface";
}

// As points throughout a body do.
TEST(Layers, AreNotPointsThatFillASpace) {
    EXPECT_EQ(layering_of(views(2 * kEdge, 0.5 * kEdge)), 0);
    Cloud cube;
    Random random(1);
    for (int i = 0; i < kPoints; ++i) {
        const double x = shapes::signed_unit(random), y = shapes::signed_unit(random);
        cube.emplace_back(x, y, shapes::signed_unit(random));
    }
    EXPECT_EQ(layering_of(cube), 0);
}

TEST(Layers, LocalVariancesAreThatOfTheNoise) {
    constexpr double kNoise = 0.04;
    const double deviation = kNoise / std::sqrt(5.0);  // along one axis, of noise that fills a ball
    const FitScene scene(referee::network_of(shapes::icosphere(3)), shapes::sphere_cloud(kPoints, kNoise));
    const PerVertex<float> variances = local_variances(scene.network, scene.surface, scene.points);
    for (const VertexId v : scene.network.vertices())
        EXPECT_NEAR(std::sqrt(static_cast<double>(variances[v])), deviation, 0.15 * deviation);
}

TEST(Layers, GapsAreThoseOfTheBends) {
    EXPECT_NEAR(mean_squared_gap(Surface(referee::network_of(shapes::grid(8, 8)))), 0, 1e-9);
    const double smooth = mean_squared_gap(Surface(referee::network_of(shapes::icosphere(3))));
    // Neighbouring faces of a sphere of radius r bend by the gap edge^2 / 4 r.
    EXPECT_NEAR(std::sqrt(smooth), kEdge * kEdge / 4, 0.3 * kEdge * kEdge / 4);
    EXPECT_GT(mean_squared_gap(Surface(referee::network_of(shapes::icosphere(3), 0.3 * kEdge))), 5 * smooth);
}

/// Mean angle in degrees between the faces of \p network and a sphere around the origin.
double roughness(const Network& network) {
    const Surface surface(network);
    double sum = 0;
    for (int f = 0; f < surface.face_count(); ++f) {
        const Vector3 middle = surface.corner(f, 0) + surface.corner(f, 1) + surface.corner(f, 2);
        sum +=
            std::acos(std::min(1.0, static_cast<double>(unit_normal(surface, f).dot(middle.normalized()))));
    }
    return sum * 57.3 / surface.face_count();
}

TEST(Layers, AreCrossedSmoothly) {
    Network network = referee::network_of(shapes::icosphere(3), 0.4 * kEdge);
    const double before = roughness(network);
    const Cloud cloud = views(1.2 * kEdge, 0.1 * kEdge);
    NoProgress progress;
    const TargetSpace target = soundness::target_of(cloud);
    for (const VertexId v : network.vertices())
        network.set_position(v, target.frame().inside(vcg::Point3d::Construct(network.position(v))));
    const FitReport report = fit_to_points(network, target, {}, 1, 1, progress);
    EXPECT_TRUE(report.improved);
    EXPECT_LT(roughness(network), 10) << before << " before";
}

}  // namespace
}  // namespace neuralmesh
