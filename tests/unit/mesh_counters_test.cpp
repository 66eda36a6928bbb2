// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Counters of given meshes: they find the creases of the mesh whatever its order, its kind and the threads.
#include "vcg_core/mesh_counters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/base/error.h"

namespace neuralmesh {
namespace {

using shapes::Shape;

/// The unit cube's surface around the origin as a lattice of \p n edges per side, each cell two faces.
Shape fine_cube(int n) {
    Shape shape;
    std::map<std::array<int, 3>, int> ids;
    const auto id = [&](std::array<int, 3> at) {
        const auto found = ids.emplace(at, static_cast<int>(shape.positions.size()));
        if (found.second)
            shape.positions.emplace_back(at[0] / double(n) - 0.5, at[1] / double(n) - 0.5,
                                         at[2] / double(n) - 0.5);
        return found.first->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int side : {0, n})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto at = [&](int di, int dj) {
                        std::array<int, 3> place{};
                        place[axis] = side;
                        place[(axis + 1) % 3] = i + di;
                        place[(axis + 2) % 3] = j + dj;
                        return id(place);
                    };
                    int corners[] = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
                    if (side == 0) std::swap(corners[1], corners[3]);
                    shape.faces.push_back({corners[0], corners[1], corners[2]});
                    shape.faces.push_back({corners[0], corners[2], corners[3]});
                }
    return shape;
}

/// Lattice steps of \p p from the planes of the cube's sides, ascending: the second is the distance from the
/// nearest edge, the third that along it from the corner.
std::array<double, 3> steps_inside(const vcg::Point3d& p, int n) {
    std::array<double, 3> inside{};
    for (int k = 0; k < 3; ++k) inside[static_cast<std::size_t>(k)] = n * (0.5 - std::abs(p[k]));
    std::sort(inside.begin(), inside.end());
    return inside;
}

MeshCounters count(const Shape& mesh, const TargetSpace& target, const Settings& settings = {}) {
    NoProgress progress;
    return mesh_counters(mesh, target, settings, progress);
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
    for (const int n : {10, 25}) {
        SCOPED_TRACE(n);
        const Shape cube = fine_cube(n);
        for (const TargetSpace& target :
             {targets::target_of(cube), targets::target_of(shapes::box_cloud(20000, {1, 1, 1}, 0.003))}) {
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
    shapes::Cloud cloud;
    vcg::Box3d box;
    for (const vcg::Point3d& p : plane.positions) box.Add(p);
    for (int i = 0; i < 20000; ++i)
        cloud.emplace_back(box.min[0] + box.DimX() * double(random.unit()),
                           box.min[1] + box.DimY() * double(random.unit()),
                           0.002 * box.Diag() * shapes::signed_unit(random));
    const MeshCounters found = count(plane, targets::target_of(cloud));
    EXPECT_EQ(found.report.feature_vertices, 0);
}

TEST(MeshCounters, AreTheSameWithAnyNumberOfThreads) {
    const Shape mesh = shapes::torus_grid(70, 40);
    const TargetSpace target = targets::target_of(shapes::torus_cloud(20000, 0.005));
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
    const Shape cube = fine_cube(10);
    const TargetSpace target = targets::target_of(shapes::box_cloud(20000));
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
    const TargetSpace ball = targets::target_of(shapes::sphere_cloud(4000));
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
    shapes::Cloud cloud = shapes::sphere_cloud(20000);
    Random random(3);
    for (int i = 0; i < 100; ++i) cloud.push_back(shapes::in_cube(random) * 3);
    const MeshCounters found = count(ball, targets::target_of(cloud));
    EXPECT_GT(found.report.outliers, 50);
    EXPECT_EQ(found.report.warnings.size(), 1U);
    EXPECT_EQ(found.report.feature_vertices, 0);
}

std::string complaint(const Shape& mesh, const Settings& settings = {}) {
    try {
        count(mesh, targets::target_of(shapes::sphere_cloud(4000)), settings);
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).back(), '.');
        return error.what();
    }
    return {};
}

/// given_start_test.cpp has all breaches; here it matters that the sentences speak of this filter.
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

/// Stops at the call of the given number.
class Stopping : public Progress {
public:
    explicit Stopping(int at) : at_(at) {}
    bool operator()(double fraction, const char* text) override {
        EXPECT_GE(fraction, last_);
        EXPECT_LE(fraction, 1);
        EXPECT_NE(text, nullptr);
        last_ = fraction;
        return ++calls < at_;
    }
    int calls = 0;

private:
    int at_;
    double last_ = 0;
};

TEST(MeshCounters, GiveTheValuesSoFarWhenCancelled) {
    const Shape mesh = shapes::icosphere(3);
    const TargetSpace target = targets::target_of(shapes::sphere_cloud(4000));
    for (const int at : {1, 20, 1000}) {
        Stopping progress(at);
        const MeshCounters found = mesh_counters(mesh, target, {}, progress);
        const bool stopped = at < 1000;
        EXPECT_EQ(found.report.stop_reason == StopReason::cancelled, stopped);
        EXPECT_EQ(found.report.signals < 60000, stopped);
        EXPECT_EQ(progress.calls, stopped ? at : progress.calls);
        for (const float value : found.counters) EXPECT_TRUE(value >= 0 && value < 1e6F);
    }
}

}  // namespace
}  // namespace neuralmesh
