// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The points of a fit: sampling, assignment to faces, noise variance, support of faces, and the error at
// held-out points.
#include "tests/unit/fit/fit_scene.h"
#include "tests/unit/support/runs.h"
#include "vcg_core/fit/fitter.h"
#include "vcg_core/fit/noise.h"
#include "vcg_core/fit/support.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh::fit_points_test {

double normal_deviate(Random& random) {
    const double u = 1 - shapes::unit(random);
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * shapes::kPi * shapes::unit(random));
}

TEST(ChoosePoints, TakesEveryPointOfACloudOnce) {
    const TargetSpace target = target_of(shapes::sphere_cloud(2000));
    Random random(1);
    const PointChoice choice = choose_points(target, 5000, random);
    EXPECT_EQ(choice.held_out.points.size(), 250U);
    EXPECT_EQ(choice.fitted.points.size(), 1750U);
    std::set<std::array<float, 3>> places;
    for (const auto* part : {&choice.fitted, &choice.held_out})
        for (const Vector3& p : part->points) places.insert({p[0], p[1], p[2]});
    EXPECT_EQ(places.size(), 2000U);
}

TEST(PrecisePoints, AreManyForEachVertexAndWithoutNoise) {
    const auto precise = [&](int count, double noise) {
        const TargetSpace target = target_of(shapes::sphere_cloud(count, noise));
        Network network = network_in_frame(target, shapes::icosphere(3));
        Random random(1);
        Fitter fitter(network, choose_points(target, 100000, random), FitOptions(), one_thread());
        const Surface surface(network);
        fitter.locate_points(surface);
        return fitter.has_precise_points(surface);
    };
    EXPECT_TRUE(precise(10000, 0));
    EXPECT_FALSE(precise(5000, 0)) << "seven for each of 642 vertices";
    EXPECT_FALSE(precise(10000, 0.02)) << "up to an eighth of an edge off";
}

/// Sums over the points of a choice above and below the plane z = 0.
struct Halves {
    double upper = 0;
    double lower = 0;
    double share() const { return upper / (upper + lower); }
};

Halves weights_of(const PointChoice& choice) {
    Halves sums;
    for (const TrackedPoints* part : {&choice.fitted, &choice.held_out})
        for (std::size_t i = 0; i < part->points.size(); ++i)
            (part->points[i][2] > 0 ? sums.upper : sums.lower) += static_cast<double>(part->weights[i]);
    return sums;
}

std::size_t count_of(const PointChoice& choice) {
    return choice.fitted.points.size() + choice.held_out.points.size();
}

// The upper half of the sphere has a fortieth of the points.
TEST(ChoosePoints, WeighsTheHalvesOfAnUnevenSphereByAreaAndTakesTheSparsePointsFirst) {
    const TargetSpace given = target_of(shapes::uneven_sphere_cloud(20000, 40));
    const auto target = given.evenly(CloudSurvey(given.positions(), 1));
    ASSERT_TRUE(target.has_value());
    for (const std::size_t wanted : {30000U, 20000U, 5000U, 1000U, 800U}) {
        Random random(1);
        const PointChoice choice = choose_points(*target, wanted, random);
        const std::size_t most = std::min<std::size_t>(wanted, 20000);
        EXPECT_NEAR(static_cast<double>(count_of(choice)), static_cast<double>(most),
                    0.05 * static_cast<double>(most));
        const Halves halves = weights_of(choice);
        EXPECT_NEAR(halves.share(), 0.5, 0.05) << wanted;
        EXPECT_NEAR(halves.upper + halves.lower, static_cast<double>(count_of(choice)),
                    0.05 * static_cast<double>(most));
        if (wanted > 1000) continue;
        Halves counts;
        for (const Vector3& p : choice.fitted.points) (p[2] > 0 ? counts.upper : counts.lower) += 1;
        EXPECT_GT(counts.share(), 0.3) << "of the cloud it is .024";
    }
}

TEST(PointsByFace, WeighPointsByTheirInfluence) {
    const Network network = network_of(shapes::icosphere(2));
    const Surface surface(network);
    TrackedPoints tracked;
    for (const vcg::Point3d& p : shapes::sphere_cloud(2000)) {
        tracked.points.push_back(to_eigen(vcg::Point3f::Construct(p)));
        tracked.weights.push_back(p[2] > 0 ? 2.0F : 0.5F);
    }
    const PointsByFace points =
        group_by_face(surface, tracked, nearest_by_tree(surface, tracked, one_thread()), one_thread());
    for (std::size_t i = 0; i < tracked.points.size(); ++i)
        EXPECT_EQ(tracked.weights[i], tracked.points[i][2] > 0 ? 2.0F : 0.5F) << "reordered with the points";
    for (int f = 0; f < surface.face_count(); ++f) {
        float sum = 0;
        for (const PointsByFace::Assignment& a : points.of(f)) sum += a.point[2] > 0 ? 2.0F : 0.5F;
        EXPECT_FLOAT_EQ(points.weight(f), sum);
        const int both = 2 * points.of(f).size();
        EXPECT_FLOAT_EQ(points.mean_weight(f, f), both > 0 ? 2 * sum / static_cast<float>(both) : 1);
    }
}

TEST(PointsByFace, HaveEveryPointWithItsNearestFace) {
    const FitScene scene(network_of(shapes::torus_grid(20, 10), 0.02), shapes::torus_cloud(2000, 0.02));
    const FaceTree tree(scene.surface, one_thread());
    std::size_t i = 0;
    for (int f = 0; f < scene.surface.face_count(); ++f)
        for (const PointsByFace::Assignment& a : scene.points.of(f)) {
            EXPECT_EQ(tree.nearest(a.point).face, f);
            EXPECT_EQ(scene.tracked.points[i], a.point) << "reordered with them";
            const WalkStart start = scene.tracked.last_hit[i];
            EXPECT_EQ(scene.surface.faces_around(start.vertex)[start.turn], f);
            ++i;
        }
    EXPECT_EQ(i, 2000U);
}

TEST(NoiseVariance, IsThatOfANoisyPlane) {
    ThreadTeam team(2);
    const Surface plane(network_of(shapes::grid(10, 10)));
    for (double sigma : {0.001, 0.01}) {
        const PointsByFace points =
            points_on(plane, 100, [&](Random& random) { return sigma * normal_deviate(random); });
        EXPECT_NEAR(noise_variance(plane, points, team) / (sigma * sigma), 1, 0.05);
    }
}

TEST(NoiseVariance, OfEachPlaceIsThatOfTheNoise) {
    constexpr double kNoise = 0.04;
    const double deviation = kNoise / std::sqrt(5.0);  // along one axis, of noise that fills a ball
    const FitScene scene(network_of(shapes::icosphere(3)), shapes::sphere_cloud(20000, kNoise));
    const PerVertex<float> variances = local_variances(scene.network, scene.surface, scene.points);
    for (const VertexId v : scene.network.vertices())
        EXPECT_NEAR(std::sqrt(static_cast<double>(variances[v])), deviation, 0.15 * deviation);
}

TEST(NoiseVariance, IsNotThatOfTheMisfit) {
    ThreadTeam team(2);
    const Surface sphere(network_of(shapes::icosphere(2)));
    EXPECT_LT(noise_variance(sphere, points_on(sphere, 20, [](Random&) { return 0.1; }), team), 1e-10);
}

TEST(NoiseVariance, IsZeroWithTooFewPoints) {
    ThreadTeam team(2);
    const Surface sphere(network_of(shapes::icosphere(2)));
    const auto noise = [](Random& random) { return 0.1 * normal_deviate(random); };
    EXPECT_EQ(noise_variance(sphere, points_on(sphere, 3, noise), team), 0);
    EXPECT_GT(noise_variance(sphere, points_on(sphere, 4, noise), team), 0);
}

constexpr VertexId kSpike = 7;

/// A sphere with one vertex pulled far out, and the points of the sphere.
FitScene spike_scene() {
    Network network = network_of(shapes::icosphere(3));
    network.set_position(kSpike, network.position(kSpike) * 2.0F);
    return {std::move(network), shapes::sphere_cloud(20000)};
}

TEST(Support, IsMissingAtTheTipOfASpike) {
    const FitScene scene = spike_scene();
    const PerVertex<float> missing = missing_points_at_vertices(scene.network, scene.surface, scene.points);
    EXPECT_GT(missing[kSpike], 10);
    for (VertexId v : scene.network.vertices()) {
        if (v == kSpike || scene.network.adjacent(v, kSpike)) continue;
        EXPECT_LT(missing[v], 0.2F * missing[kSpike]) << v;
    }
}

TEST(Support, ForbidsToStretchSurfaceOverAHole) {
    const FitScene scene(network_of(shapes::icosphere(3)), shapes::sphere_cloud(40000));
    const Support support(scene.network, scene.surface, scene.points);
    const Triangle face = scene.surface.faces[0];
    const float area = area_vector(scene.surface, 0).norm();
    const int points = scene.points.of(0).size();
    const auto patch = [&](float times_area, int count) {
        Support::Patch result;
        support.add(result, face, times_area * area, count);
        return result;
    };
    ASSERT_GT(points, 20);
    EXPECT_EQ(support.cost_of_change(patch(1, points), patch(1, points)), 0);
    EXPECT_EQ(support.cost_of_change(patch(1, points), patch(1.5F, points)), 0) << "still enough points";
    EXPECT_EQ(support.cost_of_change(patch(1, points), patch(1, 0)), Support::kForbidden);
    EXPECT_EQ(support.cost_of_change(patch(0.1F, 3), patch(0.11F, 3)), Support::kForbidden) << "few points";
    EXPECT_LT(support.cost_of_change(patch(1, 0), patch(0.5F, 0)), 0);
}

/// The points with their places on an even sphere, and the directions of its normals.
struct HeldOutOfASphere {
    explicit HeldOutOfASphere(const TrackedPoints& points) : held_out(points) {
        held_out.locate(sphere, team);
        held_out.set_directions(network, sphere, team);
    }
    Network network = network_of(shapes::icosphere(4));
    Surface sphere{network};
    ThreadTeam team{2};
    HeldOut held_out;
};

TEST(HeldOut, MeasuresAlongTheNormals) {
    HeldOutOfASphere of(tracked_points(shapes::sphere_cloud(2000)));
    Surface larger = of.sphere;
    for (Vector3& p : larger.positions) p *= 1.05F;
    EXPECT_LT(of.held_out.rms_error(of.sphere, 1, of.team), 0.003);
    EXPECT_NEAR(of.held_out.rms_error(larger, 1, of.team), 0.05, 0.003);
    EXPECT_NEAR(of.held_out.rms_error(larger, 0.02F, of.team), 0.02, 1e-6)
        << "counts up to the outlier distance";
}

TEST(HeldOut, WeighsTheErrorsOfItsPoints) {
    Cloud cloud = shapes::sphere_cloud(2000);
    std::vector<float> weights;
    for (vcg::Point3d& p : cloud) {
        weights.push_back(p[2] > 0 ? 0.2F : 1.8F);
        if (p[2] > 0) p *= 1.1;
    }
    TrackedPoints points = tracked_points(cloud);
    points.weights = weights;
    HeldOutOfASphere of(points);
    EXPECT_NEAR(of.held_out.rms_error(of.sphere, 1, of.team), 0.1 * std::sqrt(0.1), 0.003);
}

// Points with noise of .03: a surface crumpled as much is nearer to them than the true one, but not along the
// normals of the true one.
TEST(HeldOut, DoesNotPreferACrumpledSurface) {
    HeldOutOfASphere of(tracked_points(shapes::sphere_cloud(4000, 0.03)));
    const Surface crumpled(network_of(shapes::icosphere(4), 0.06));
    HeldOut other = of.held_out;
    other.relocate(crumpled, of.team);
    EXPECT_LT(of.held_out.rms_error(of.sphere, 1, of.team), 0.97 * other.rms_error(crumpled, 1, of.team));
}

}  // namespace neuralmesh::fit_points_test
