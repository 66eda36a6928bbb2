// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Counters of given meshes: they find the creases of the mesh whatever its order, its kind and the threads.
#include "vcg_core/mesh_counters.h"

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::mesh_counters_test {

/// Lattice steps of \p p from the planes of the cube's sides, ascending: the second is the distance from the
/// nearest edge, the third that along it from the corner.
std::array<double, 3> steps_inside(const vcg::Point3d& p, int n) {
    std::array<double, 3> inside{};
    for (int k = 0; k < 3; ++k) inside[static_cast<std::size_t>(k)] = n * (0.5 - std::abs(p[k]));
    std::sort(inside.begin(), inside.end());
    return inside;
}

MeshCounters count(const Shape& mesh, const TargetSpace& target, const Settings& settings = {}) {
    return mesh_counters(mesh, target, settings, unwatched());
}

/// Every vertex on an edge of the cube is a feature, no vertex two steps away is one. Three planes meet at a
/// corner, of which the measure knows two: there it may miss vertices.
void expect_edges(const MeshCounters& found, const Shape& cube, int n) {
    int missing = 0, wrong = 0, on_edges = 0;
    for (std::size_t i = 0; i < cube.positions.size(); ++i) {
        const std::array<double, 3> steps = steps_inside(cube.positions[i], n);
        const bool feature = found.features[i] != 0;
        if (steps[1] < 0.1 && steps[2] > 2.1) {
            ++on_edges;
            missing += feature ? 0 : 1;
        }
        wrong += steps[1] > 1.9 && feature ? 1 : 0;
    }
    EXPECT_EQ(on_edges, 12 * (n - 5));
    EXPECT_EQ(missing, 0);
    EXPECT_EQ(wrong, 0);
}

/// Also with more vertices than learning leaves in their order.
TEST(MeshCounters, FindTheEdgesOfACube) {
    for (const int halvings : {3, 5}) {
        const int n = 1 << halvings;
        SCOPED_TRACE(n);
        const Shape cube = shapes::fine_cube(halvings);
        for (const TargetSpace& target :
             {target_of(cube), target_of(shapes::box_cloud(20000, {1, 1, 1}, 0.003))}) {
            Settings settings;
            const MeshCounters found = count(cube, target, settings);
            expect_edges(found, cube, n);
            EXPECT_EQ(found.report.vertices, static_cast<int>(cube.positions.size()));
            EXPECT_EQ(found.report.feature_vertices,
                      std::count(found.features.begin(), found.features.end(), 1));
            EXPECT_NEAR(found.report.mean_counter, 1, 0.35);
            EXPECT_EQ(found.report.signals, std::max(60000, 60 * found.report.vertices));
            EXPECT_EQ(found.report.stop_reason, StopReason::target_reached);
        }
    }
}

/// A plane has no features, though its faces are of many sizes and the points are noisy.
TEST(MeshCounters, FindNothingOnAPlane) {
    Shape plane = shapes::grid(25, 25);
    Random random(5);
    for (vcg::Point3d& p : plane.positions) {
        p[0] += 0.3 / 25 * shapes::signed_unit(random);
        p[1] += 0.3 / 25 * shapes::signed_unit(random);
    }
    Cloud cloud;
    vcg::Box3d box;
    for (const vcg::Point3d& p : plane.positions) box.Add(p);
    for (int i = 0; i < 20000; ++i)
        cloud.emplace_back(box.min[0] + box.DimX() * double(random.unit()),
                           box.min[1] + box.DimY() * double(random.unit()),
                           0.002 * box.Diag() * shapes::signed_unit(random));
    const MeshCounters found = count(plane, target_of(cloud));
    EXPECT_EQ(found.report.feature_vertices, 0);
}

TEST(MeshCounters, AreTheSameWithAnyNumberOfThreads) {
    const Shape mesh = shapes::torus_grid(70, 40);
    const TargetSpace target = target_of(shapes::torus_cloud(20000, 0.005));
    Settings settings;
    settings.threads = 1;
    const MeshCounters alone = count(mesh, target, settings);
    for (const int threads : {2, 3}) {
        settings.threads = threads;
        const MeshCounters together = count(mesh, target, settings);
        EXPECT_EQ(together.counters, alone.counters);
        EXPECT_EQ(together.features, alone.features);
    }
    settings.random_seed = 2;
    EXPECT_NE(count(mesh, target, settings).counters, alone.counters);
}

TEST(MeshCounters, AreZeroWhereNoFaceIs) {
    const Shape cube = shapes::fine_cube(3);
    const TargetSpace target = target_of(shapes::box_cloud(20000));
    const MeshCounters expected = count(cube, target);
    // Unused vertices before, between and behind the others.
    Shape sparse;
    std::vector<int> place;
    for (const vcg::Point3d& p : cube.positions) {
        if (place.size() % 50 == 0) sparse.positions.emplace_back(7, 7, double(place.size()));
        place.push_back(static_cast<int>(sparse.positions.size()));
        sparse.positions.push_back(p);
    }
    sparse.positions.emplace_back(0, 0, 0);
    for (const auto& [a, b, c] : cube.faces)
        sparse.faces.push_back({place[static_cast<std::size_t>(a)], place[static_cast<std::size_t>(b)],
                                place[static_cast<std::size_t>(c)]});
    const MeshCounters found = count(sparse, target);
    ASSERT_EQ(found.counters.size(), sparse.positions.size());
    double sum = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
        const auto at = static_cast<std::size_t>(place[i]);
        EXPECT_EQ(found.counters[at], expected.counters[i]);
        EXPECT_EQ(found.features[at], expected.features[i]);
        sum += static_cast<double>(found.counters[at]);
    }
    double all = 0;
    for (const float value : found.counters) all += static_cast<double>(value);
    EXPECT_EQ(all, sum) << "the unused vertices have no value";
    EXPECT_EQ(found.report.vertices, expected.report.vertices);
    EXPECT_EQ(found.report.mean_counter, expected.report.mean_counter);
}

/// One triangle, a vertex of 100 neighbours, several components, boundaries: every value is finite.
TEST(MeshCounters, HoldForEveryManifold) {
    Shape two = shapes::icosphere(2);
    shapes::append(two, shapes::grid(6, 6), {3, 0, 0});
    shapes::append(two, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {0, 3, 0});
    const Shape triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const TargetSpace ball = target_of(shapes::sphere_cloud(4000));
    for (const Shape& mesh : {shapes::tetrahedron(), triangle, shapes::bipyramid(100), shapes::fan(60), two,
                              shapes::tube(9, 5), shapes::cube()}) {
        const MeshCounters found = count(mesh, ball);
        EXPECT_EQ(found.report.vertices, static_cast<int>(mesh.positions.size()));
        ASSERT_EQ(found.counters.size(), mesh.positions.size());
        for (const float value : found.counters) EXPECT_TRUE(value >= 0 && value < 1e6F) << value;
    }
}

/// The outliers of a cloud would pull single vertices out of the surface.
TEST(MeshCounters, LeaveOutliersOut) {
    const Shape ball = shapes::icosphere(3);
    Cloud cloud = shapes::sphere_cloud(20000);
    Random random(3);
    for (int i = 0; i < 100; ++i) cloud.push_back(shapes::in_cube(random) * 3);
    const MeshCounters found = count(ball, target_of(cloud));
    EXPECT_GT(found.report.outliers, 50);
    EXPECT_EQ(found.report.warnings.size(), 1U);
    EXPECT_EQ(found.report.feature_vertices, 0);
}

std::string complaint(const Shape& mesh, const Settings& settings = {}) {
    return complaint_of([&] { count(mesh, target_of(shapes::sphere_cloud(4000)), settings); });
}

/// open_start_test.cpp has all breaches; here it matters that the sentences speak of this filter.
TEST(MeshCounters, RefuseWhatIsNoManifold) {
    const Shape sphere = shapes::icosphere(1);
    const std::string empty = complaint({sphere.positions, {}});
    EXPECT_EQ(empty.find("The current layer has no faces"), 0U) << empty;
    EXPECT_NE(empty.find("'Signal layer'"), std::string::npos) << empty;

    Shape doubled = sphere;
    doubled.faces.push_back(doubled.faces[3]);
    const std::string breach = complaint(doubled);
    EXPECT_EQ(breach.find("The current layer is no manifold"), 0U) << breach;
    EXPECT_NE(breach.find("filter 'Remove Duplicate Faces'."), std::string::npos) << breach;

    Shape far = sphere;
    for (vcg::Point3d& p : far.positions) p += vcg::Point3d(5, 0, 0);
    EXPECT_EQ(complaint(far).find("The current layer lies apart from the points"), 0U) << complaint(far);

    Settings settings;
    settings.signals_per_vertex = 0;
    EXPECT_EQ(complaint(sphere, settings).find("The parameter signals_per_vertex "), 0U);
}

TEST(MeshCounters, GiveTheValuesSoFarWhenCancelled) {
    const Shape mesh = shapes::icosphere(3);
    const TargetSpace target = target_of(shapes::sphere_cloud(4000));
    for (const int at : {1, 20, 1000}) {
        Watch progress(at - 1);
        const MeshCounters found = mesh_counters(mesh, target, {}, progress);
        const bool stopped = at < 1000;
        EXPECT_EQ(found.report.stop_reason == StopReason::cancelled, stopped);
        EXPECT_EQ(found.report.signals < 60000, stopped);
        EXPECT_EQ(progress.steps_back, 0);
        EXPECT_TRUE(!stopped || progress.calls == at);
        for (const float value : found.counters) EXPECT_TRUE(value >= 0 && value < 1e6F);
    }
}

}  // namespace neuralmesh::mesh_counters_test
