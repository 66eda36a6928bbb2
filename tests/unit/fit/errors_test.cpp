// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Stray points, and the error at the points.
#include "tests/unit/fit/fit_scene.h"
#include "vcg_core/fit/noise.h"
#include "vcg_core/fit/point_errors.h"

namespace neuralmesh::errors_test {

// Which points are astray, on a sphere with points above it.

constexpr float kDeviations = 4;
constexpr double kSurface = 1.02;  // points of the sphere and its noise lie below this radius

vcg::Point3d direction(Random& random) { return shapes::in_ball(random).Normalize(); }

/// The points of \p scene that are astray.
std::vector<Vector3> strays_of(const FitScene& scene) {
    ThreadTeam team(2);
    const StrayPoints strays(scene.network, scene.surface, scene.points, kDeviations, team);
    std::vector<Vector3> result;
    for (int f = 0; f < scene.surface.face_count(); ++f)
        for (const PointsByFace::Assignment& a : scene.points.of(f))
            if (strays.contain(a, f)) result.push_back(a.point);
    return result;
}

int count_above(const std::vector<Vector3>& points, double radius) {
    return static_cast<int>(std::count_if(points.begin(), points.end(), [radius](const Vector3& p) {
        return static_cast<double>(p.norm()) > radius;
    }));
}

FitScene sphere_with(const Cloud& more, double noise = 0.003) {
    Cloud cloud = shapes::sphere_cloud(20000, noise);
    cloud.insert(cloud.end(), more.begin(), more.end());
    return {network_of(shapes::icosphere(3)), cloud};
}

TEST(StrayPoints, OfASphereAloneAreNextToNone) {
    EXPECT_TRUE(strays_of(sphere_with({}, 0)).empty());
    EXPECT_LE(strays_of(sphere_with({})).size(), 4U);
}

TEST(StrayPoints, AreSingleOnesCloseToTheSurface) {
    Random random(3);
    Cloud more;
    for (int i = 0; i < 100; ++i) more.push_back(direction(random) * (1.04 + 0.001 * i));
    const std::vector<Vector3> strays = strays_of(sphere_with(more));
    EXPECT_GE(count_above(strays, kSurface), 95);
    EXPECT_LE(strays.size() - static_cast<std::size_t>(count_above(strays, kSurface)), 4U);
}

TEST(StrayPoints, ArePairsAndTriples) {
    for (const int together : {2, 3}) {
        Cloud more;
        for (int i = 0; i < together; ++i) more.emplace_back(0.01 * i, 0.0, 1.06);
        EXPECT_EQ(count_above(strays_of(sphere_with(more)), kSurface), together);
    }
}

TEST(StrayPoints, AreNotThoseOfATipThatTheMeshHasNotReached) {
    Random random(5);
    for (const int count : {50, 400}) {
        Cloud cone;  // of height .2 on a sphere, which the mesh leaves out
        for (int i = 0; i < count; ++i) {
            const double down = std::sqrt(shapes::unit(random));
            const double turn = 2 * shapes::kPi * shapes::unit(random);
            cone.emplace_back(0.1 * down * std::cos(turn), 0.1 * down * std::sin(turn), 1.2 - 0.2 * down);
        }
        EXPECT_LE(count_above(strays_of(sphere_with(cone)), kSurface), count / 20) << count;
    }
}

// In a sparse place a stray point may be most of what the faces around a vertex have.
TEST(StrayPoints, DoNotHideWherePointsAreFew) {
    Cloud cloud;
    for (const vcg::Point3d& p : shapes::sphere_cloud(20000, 0.003))
        if (p[2] < 0.97) cloud.push_back(p);
    cloud.emplace_back(0.0, 0.0, 1.06);
    const FitScene scene(network_of(shapes::icosphere(3)), cloud);
    EXPECT_EQ(count_above(strays_of(scene), kSurface), 1);
}

TEST(StrayPoints, AreNotThoseBeyondABoundary) {
    Random random(7);
    const auto along = [&random] { return shapes::unit(random) - 0.5; };
    Cloud cloud;  // wider than the mesh by a strip with few points, and one point above the middle
    for (int i = 0; i < 5000; ++i) cloud.emplace_back(along(), along(), 0.0);
    for (int i = 0; i < 100; ++i) cloud.emplace_back(0.55 + 0.1 * along(), along(), 0.0);
    cloud.emplace_back(0.0, 0.0, 0.03);
    const FitScene scene(network_of(shapes::grid(10, 10)), cloud);
    const std::vector<Vector3> strays = strays_of(scene);
    ASSERT_EQ(strays.size(), 1U);
    EXPECT_EQ(strays[0], Vector3(0, 0, 0.03F));
}

// The reported distance of the points from the mesh: exact for small clouds, of random points for large ones.

// One of 100 points lies 2 away from the sphere: random points would count it 0, 1, 2 times or more.
TEST(RmsError, IsThatOfAllPointsOfASmallCloud) {
    Cloud cloud = shapes::sphere_cloud(100);
    cloud[50] = cloud[50] * 3;
    const TargetSpace target = target_of(cloud);
    const Network sphere = network_in_frame(target, shapes::icosphere(5));
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

}  // namespace neuralmesh::errors_test
