// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Clouds of views that do not quite meet, and clouds of independent noise, on a sphere.
#include "vcg_core/fit/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/fit/fit_scene.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/fit/fit.h"
#include "vcg_core/fit/noise.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;

constexpr double kEdgeLength = 0.15;  // of icosphere(3) of radius 1
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

float points_per_vertex(const FitScene& scene) {
    return scene.points.per_vertex(scene.network.vertex_count());
}

float layering_of(const Cloud& cloud) {
    const FitScene scene(referee::network_of(shapes::icosphere(3)), cloud);
    const PerVertex<float> variances = local_variances(scene.network, scene.surface, scene.points);
    return layering(scene.network, scene.surface, variances, points_per_vertex(scene));
}

TEST(Layers, AreTheViewsThatDoNotMeet) {
    EXPECT_GT(layering_of(views(0.8 * kEdgeLength, 0.05 * kEdgeLength)), 0.9F);
    EXPECT_GT(layering_of(views(0.5 * kEdgeLength, 0.2 * kEdgeLength)), 0.5F);
}

TEST(Layers, AreNeitherNoiseNorCleanPoints) {
    for (const double noise : {0.0, 0.05, 0.2, 0.4}) {
        EXPECT_EQ(layering_of(shapes::sphere_cloud(kPoints, noise * kEdgeLength)), 0) << noise;
        EXPECT_EQ(layering_of(views(0, noise * kEdgeLength)), 0) << noise;
    }
    EXPECT_EQ(layering_of(views(0.05 * kEdgeLength, 0)), 0) << "close to the surface";
}

TEST(Layers, AreNotTheChanceOfFewPoints) {
    constexpr int kFew = 6000;  // for 642 vertices
    for (const double noise : {0.3, 0.4, 0.5})
        EXPECT_EQ(layering_of(shapes::sphere_cloud(kFew, noise * kEdgeLength)), 0) << noise;
}

// As points throughout a body do.
TEST(Layers, AreNotPointsThatFillASpace) {
    EXPECT_EQ(layering_of(views(2 * kEdgeLength, 0.5 * kEdgeLength)), 0);
    Cloud cube;
    Random random(1);
    for (int i = 0; i < kPoints; ++i) {
        const double x = shapes::signed_unit(random), y = shapes::signed_unit(random);
        cube.emplace_back(x, y, shapes::signed_unit(random));
    }
    EXPECT_EQ(layering_of(cube), 0);
}

/// One view of the unit sphere from all around, and \p second, moved outward by \p shift, of the points from
/// the height of .4 up only.
Cloud two_views_on_top(double shift, double noise) {
    Cloud cloud = shapes::sphere_cloud(kPoints, noise, 1);
    for (vcg::Point3d p : shapes::sphere_cloud(kPoints, noise, 2))
        if (p[2] > 0.4) cloud.push_back(p + p * shift);
    return cloud;
}

TEST(Layers, AreFoundWhereTheyAre) {
    const FitScene scene(referee::network_of(shapes::icosphere(3)),
                         two_views_on_top(0.8 * kEdgeLength, 0.05 * kEdgeLength));
    const PerVertex<float> variances = local_variances(scene.network, scene.surface, scene.points);
    EXPECT_EQ(layering(scene.network, scene.surface, variances, points_per_vertex(scene)), 0)
        << "not over most of the surface";
    const PerVertex<float> local = local_layering(scene.network, scene.surface, variances);
    for (const VertexId v : scene.network.vertices()) {
        const float height = scene.network.position(v)[2];
        if (height > 0.6F) {
            EXPECT_GT(local[v], 0.9F) << height;
        } else if (height < 0) {
            EXPECT_EQ(local[v], 0) << height;
        }
    }
}

float most_local_layering_of(const Cloud& cloud) {
    const FitScene scene(referee::network_of(shapes::icosphere(3)), cloud);
    const PerVertex<float> variances = local_variances(scene.network, scene.surface, scene.points);
    const PerVertex<float> local = local_layering(scene.network, scene.surface, variances);
    return *std::max_element(local.begin(), local.end());
}

TEST(Layers, AreNowhereInNoise) {
    for (const double noise : {0.0, 0.05, 0.2, 0.4})
        EXPECT_EQ(most_local_layering_of(shapes::sphere_cloud(kPoints, noise * kEdgeLength)), 0) << noise;
}

// Points that fill a space are spread unevenly, but hardly less widely anywhere.
TEST(Layers, AreNotOfAPartWhereMostIsSpreadWidely) {
    Cloud cloud = shapes::sphere_cloud(kPoints, 0, 1);
    Random random(1);
    for (vcg::Point3d& p : cloud) p *= 1 + (0.1 + 0.05 * p[2]) * shapes::signed_unit(random);
    EXPECT_EQ(most_local_layering_of(cloud), 0);
}

// Ripples that are narrower than the edges, and higher towards the top.
TEST(Layers, AreNotRipplesThatTheMeshDoesNotFollow) {
    Cloud cloud = shapes::sphere_cloud(kPoints);
    for (vcg::Point3d& p : cloud) {
        const double height = 0.5 * kEdgeLength * (1 + p[2]) / 2;
        p *= 1 + height * std::sin(40 * p[0]) * std::sin(40 * p[1]);
    }
    EXPECT_EQ(most_local_layering_of(cloud), 0);
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
    EXPECT_NEAR(std::sqrt(smooth), kEdgeLength * kEdgeLength / 4, 0.3 * kEdgeLength * kEdgeLength / 4);
    EXPECT_GT(mean_squared_gap(Surface(referee::network_of(shapes::icosphere(3), 0.3 * kEdgeLength))),
              5 * smooth);
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

struct Roughness {
    double before, after;
};

/// Of a sphere that learning left rough, and after its fit to \p cloud; the same if the fit is not kept.
Roughness fitted_to(const Cloud& cloud, double roughness_of_learning) {
    Network network = referee::network_of(shapes::icosphere(3), roughness_of_learning);
    const double before = roughness(network);
    NoProgress progress;
    const TargetSpace target = soundness::target_of(cloud);
    for (const VertexId v : network.vertices())
        network.set_position(v, target.frame().inside(vcg::Point3d::Construct(network.position(v))));
    fit_to_points(network, target, {}, 1, 1, progress);
    return {before, roughness(network)};
}

TEST(Layers, AreCrossedSmoothly) {
    const Roughness found = fitted_to(views(1.2 * kEdgeLength, 0.1 * kEdgeLength), 0.4 * kEdgeLength);
    EXPECT_LT(found.after, 10) << found.before << " before";
}

// The points are nearest to a surface that runs from one layer to the next and back, at 40 to 50 degrees.
TEST(Layers, OfAPartAreCrossedSmoothly) {
    for (const double shift : {0.4, 0.8}) {
        const Cloud cloud = two_views_on_top(shift * kEdgeLength, 0.1 * kEdgeLength);
        EXPECT_LT(fitted_to(cloud, 0.1 * kEdgeLength).after, 6) << shift;
        const Roughness found = fitted_to(cloud, 0.4 * kEdgeLength);
        EXPECT_LT(found.after, 0.9 * found.before) << shift << ": " << found.before;
    }
}

}  // namespace
}  // namespace neuralmesh
