// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The fit as a whole: it comes closer to the points, keeps the topology, and gives the same bytes for any
// number of threads.
#include "vcg_core/fit/fit.h"

#include "tests/unit/support/runs.h"
#include "vcg_core/fit/point_errors.h"
#include "vcg_core/mesh/self_intersections.h"

namespace neuralmesh::fit_test {

FitReport fit(Network& network, const TargetSpace& target, const FitOptions& options = {}, int threads = 1) {
    return fit_to_points(network, target, options, threads, 1, unwatched());
}

FitOptions reduced_to(int vertices, bool by_volume = false) {
    FitOptions options;
    options.reduce_to = vertices;
    options.by_volume = by_volume;
    return options;
}

double rms(const TargetSpace& target, const Network& network) {
    Random random(9);
    return rms_distance(target, network, 5000, random, one_thread());
}

/// Root mean square over the vertices of \p off, of their places in the coordinates of the cloud.
template <class Off>
double rms_of_vertices(const TargetSpace& target, const Network& network, const Off& off) {
    double sum = 0;
    for (const VertexId v : network.vertices())
        sum += std::pow(off(target.frame().outside(network.position(v))), 2);
    return std::sqrt(sum / network.vertex_count());
}

/// The largest angle between the normals of neighbouring faces, as a cosine.
double sharpest_fold(const Network& network) {
    const auto normal = [&](VertexId a, VertexId b, VertexId c) {
        const vcg::Point3f n =
            (network.position(b) - network.position(a)) ^ (network.position(c) - network.position(a));
        return n / std::max(n.Norm(), 1e-20F);
    };
    double least = 1;
    for (VertexId a = 0; a < network.slot_count(); ++a) {
        const Ring& ring = network.ring(a);
        for (int i = 0; i < ring.valence && ring.open == 0; ++i)
            least = std::min(least, static_cast<double>(normal(a, ring[i], ring.next(i)) *
                                                        normal(a, ring.previous(i), ring[i])));
    }
    return least;
}

bool same_bytes(const Network& a, const Network& b) {
    if (a.slot_count() != b.slot_count() || a.faces() != b.faces()) return false;
    for (VertexId v = 0; v < a.slot_count(); ++v)
        if (!(a.position(v) == b.position(v))) return false;
    return true;
}

TEST(Fit, BringsAnInflatedSphereToThePoints) {
    const Cloud cloud = shapes::sphere_cloud(20000);
    const TargetSpace target = target_of(cloud);
    Network network = network_in_frame(target, shapes::scaled(shapes::icosphere(3), 1.1), 0.005);
    const double before = rms(target, network);
    const FitReport report = fit(network, target);
    EXPECT_TRUE(report.improved);
    EXPECT_LT(report.rms_fitted, report.rms_unfitted);
    EXPECT_LT(rms(target, network), before / 20);
    EXPECT_EQ(network.vertex_count(), 642);
    EXPECT_EQ(topology_of(network), kBall);
    EXPECT_GT(sharpest_fold(network), 0.8);
}

// No edge of the icosphere lies on an edge of the cube: vertices have to move there.
TEST(Fit, FindsTheCreasesOfACube) {
    const TargetSpace target = target_of(shapes::box_cloud(20000));
    Network network = network_in_frame(target, shapes::scaled(shapes::icosphere(3), 0.6));
    fit(network, target);
    EXPECT_LT(rms(target, network), 0.0012);
    EXPECT_EQ(network.validate(), "");
}

TEST(Fit, GivesTheSameBytesForAnyNumberOfThreads) {
    const TargetSpace target = target_of(shapes::torus_cloud(8000, 0.01));
    for (const bool by_volume : {false, true}) {
        Network one = network_in_frame(target, shapes::scaled(shapes::torus_grid(40, 20), 1.05), 0.005);
        Network two = one;
        Network five = one;
        const FitOptions options = reduced_to(by_volume ? 300 : 500, by_volume);
        fit(one, target, options, 1);
        fit(two, target, options, 2);
        fit(five, target, options, 5);
        EXPECT_TRUE(same_bytes(one, two));
        EXPECT_TRUE(same_bytes(one, five));
    }
}

// Ten noisy points per vertex, and a mesh nearly on the surface, as learning leaves it: the fit must not pull
// it into the noise.
TEST(Fit, SmoothsNoiseRatherThanChasingIt) {
    const Cloud noisy = shapes::sphere_cloud(6420, 0.03);
    const TargetSpace target = target_of(noisy);
    Network network = network_in_frame(target, shapes::icosphere(3), 0.006);
    const auto error = [&] {
        return rms_of_vertices(target, network, [](const vcg::Point3d& p) { return p.Norm() - 1; });
    };
    const double before = error();
    fit(network, target);
    EXPECT_LT(error(), 0.6 * before);
    EXPECT_LT(error(), 0.006);
}

// A plane as a depth camera sees it, whose heights have steps of two spacings. A learned mesh that follows
// the steps is close to held-out points, too, as they lie on the same steps.
TEST(Fit, SmoothsStepsThatTheMeshFollows) {
    constexpr double kSlope = 0.5, kStep = 0.01;
    const auto stepped = [](double x) { return std::round(kSlope * x / kStep) * kStep; };
    Random random(6);
    Cloud cloud;
    for (int i = 0; i < 40000; ++i) {
        const double x = shapes::signed_unit(random) / 2;
        cloud.emplace_back(x, shapes::signed_unit(random) / 2, stepped(x));
    }
    const TargetSpace target = target_of(cloud);
    Shape shape = shapes::grid(120, 120);
    for (vcg::Point3d& p : shape.positions) p[2] = stepped(p[0]);
    Network network = network_in_frame(target, shape);
    const auto error = [&] {
        return rms_of_vertices(target, network, [](const vcg::Point3d& p) { return p[2] - kSlope * p[0]; });
    };
    const double before = error();
    Surveys surveys(target.positions(), 1);
    FitOptions options;
    options.noise = &surveys.surface();
    EXPECT_TRUE(fit(network, target, options).improved);
    EXPECT_LT(error(), before / 2);
}

TEST(Fit, IsNotDrawnByOutliers) {
    Cloud cloud = shapes::sphere_cloud(20000);
    Random random(4);
    for (int i = 0; i < 400; ++i) cloud.push_back(shapes::in_ball(random) * 1.7);
    const TargetSpace target = target_of(cloud);
    Network network = network_in_frame(target, shapes::icosphere(3), 0.004);
    fit(network, target);
    double worst = 0;
    for (VertexId v = 0; v < network.slot_count(); ++v)
        worst = std::max(worst, std::abs(target.frame().outside(network.position(v)).Norm() - 1));
    EXPECT_LT(worst, 0.03);
}

// Half of the sphere has no points: there the bending term alone has to keep the mesh smooth.
TEST(Fit, MakesNoSpikesWhereThereAreNoPoints) {
    Cloud cloud = shapes::sphere_cloud(20000);
    for (vcg::Point3d& p : cloud) p[2] = std::abs(p[2]);
    cloud.emplace_back(0.0, 0.0, -1.0);
    const TargetSpace target = target_of(cloud);
    Network network = network_in_frame(target, shapes::scaled(shapes::icosphere(3), 1.02), 0.003);
    fit(network, target);
    EXPECT_EQ(network.validate(), "");
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        const double r = target.frame().outside(network.position(v)).Norm();
        EXPECT_GT(r, 0.5);
        EXPECT_LT(r, 1.2);
    }
    EXPECT_GT(sharpest_fold(network), -0.6);
}

TEST(Fit, LeavesAnExactMeshAlone) {
    const Shape sphere = shapes::icosphere(2);
    const TargetSpace target = target_of(sphere);  // points are drawn from its own faces
    Network network = network_in_frame(target, sphere);
    const double before = rms(target, network);
    const FitReport report = fit(network, target);
    EXPECT_LE(report.rms_fitted, report.rms_unfitted);
    EXPECT_LT(rms(target, network), before + 1e-5);
}

TEST(Fit, LeavesAMeshAloneWithHardlyAnyPoints) {
    const TargetSpace target = target_of(shapes::sphere_cloud(30));
    Network network = network_in_frame(target, shapes::icosphere(1));
    const Network before = network;
    EXPECT_FALSE(fit(network, target).improved);
    EXPECT_TRUE(same_bytes(before, network));
}

TEST(Fit, RemovesTheVerticesOfLeastCost) {
    // A cube needs its eight corners only: removing vertices inside its sides costs nothing.
    const TargetSpace target = target_of(shapes::box_cloud(20000));
    for (const bool by_volume : {false, true}) {
        Network network = network_in_frame(target, shapes::scaled(shapes::icosphere(3), 0.6));
        const int before = network.vertex_count();
        const FitReport report = fit(network, target, reduced_to(60, by_volume));
        EXPECT_LT(5 * 60, before) << "far fewer than the ids in use";
        EXPECT_EQ(network.vertex_count(), 60);
        EXPECT_EQ(topology_of(network), kBall);
        EXPECT_LE(report.rms_fitted, report.rms_unfitted);
        EXPECT_LT(rms(target, network), 1e-3);
    }
}

TEST(Fit, CancelledInTheReductionItLeavesASoundMesh) {
    const TargetSpace target = target_of(shapes::sphere_cloud(5000));
    const Network start = network_in_frame(target, shapes::scaled(shapes::icosphere(3), 1.1));
    int cancelled = 0;
    for (bool reduced = false; !reduced; ++cancelled) {
        ASSERT_LT(cancelled, 40);
        Network network = start;
        Watch progress(cancelled);
        fit_to_points(network, target, reduced_to(100, true), 1, 1, progress);
        EXPECT_EQ(topology_of(network), kBall);
        reduced = network.vertex_count() == 100;
    }
    EXPECT_GT(cancelled, 4);
}

// Cancelled before smoothing and reduction have begun.
TEST(Fit, CancelledAtOnceItLeavesATangledMeshUnchanged) {
    const TargetSpace target = target_of(shapes::sphere_cloud(5000));
    Network network = network_in_frame(target, shapes::scaled(shapes::icosphere(3), 1.1), 0.05);
    ASSERT_FALSE(self_intersections(Surface(network), one_thread()).empty());
    const Network before = network;
    Watch stop(0);
    EXPECT_FALSE(fit_to_points(network, target, reduced_to(300), 1, 1, stop).improved);
    EXPECT_TRUE(same_bytes(before, network));
}

TEST(Fit, ReportsHowMuchOfItIsDone) {
    const TargetSpace target = target_of(shapes::sphere_cloud(5000));
    for (const bool by_volume : {false, true}) {
        Network network = network_in_frame(target, shapes::scaled(shapes::icosphere(3), 1.1), 0.05);
        Watch progress;
        fit_to_points(network, target, reduced_to(100, by_volume), 1, 1, progress);
        EXPECT_EQ(network.vertex_count(), 100);
        EXPECT_EQ(progress.steps_back, 0);
        EXPECT_LT(progress.standing_still, 2) << "the first round of the reduction removes none";
        EXPECT_GT(progress.last, 0.6);
    }
}

TEST(Fit, RemovesNoMoreThanTheTopologyAllows) {
    // A triangulated torus has at least seven vertices, so it cannot be reduced to four.
    const TargetSpace target = target_of(shapes::torus_cloud(8000, 0));
    Network network = network_in_frame(target, shapes::torus_grid(20, 10));
    fit(network, target, reduced_to(4));
    EXPECT_GT(network.vertex_count(), 4);
    EXPECT_EQ(topology_of(network), kRing);
}

}  // namespace neuralmesh::fit_test
