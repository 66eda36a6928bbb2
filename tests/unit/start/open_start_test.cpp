// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The open start mesh: topology, place, orientation, and what it refuses.
#include "vcg_core/start/open_start.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {
namespace {

using open_shapes::Case;
using shapes::Cloud;

OpenStart start_of(const TargetSpace& target, const OpenStartOptions& options = {}) {
    Random random(1);
    NoProgress progress;
    Surveys surveys(target.positions(), options.threads);
    return open_start(target, target.positions(), surveys, options, random, progress);
}

/// Of a cloud.
OpenStart start_of(const Cloud& cloud, const OpenStartOptions& options = {}) {
    return start_of(soundness::target_of(cloud), options);
}

bool warns(const OpenStart& start, const std::string& words) {
    return std::any_of(start.warnings.begin(), start.warnings.end(),
                       [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

double area(const OpenStart& start) {
    double sum = 0;
    for (const Triangle& f : start.faces) {
        const auto at = [&](std::size_t k) { return start.positions[static_cast<std::size_t>(f[k])]; };
        sum += static_cast<double>(((at(1) - at(0)) ^ (at(2) - at(0))).Norm()) / 2;
    }
    return sum;
}

/// Largest distance of a vertex from the nearest point.
double farthest(const OpenStart& start, const TargetSpace& target) {
    double most = 0;
    for (const vcg::Point3f& v : start.positions) {
        float least = 1e30F;
        for (const vcg::Point3f& p : target.positions()) least = std::min(least, (v - p).SquaredNorm());
        most = std::max(most, std::sqrt(static_cast<double>(least)));
    }
    return most;
}

TEST(OpenStart, HasTheTopologyOfTheSurface) {
    for (const Case& each : open_shapes::cases()) {
        SCOPED_TRACE(each.name);
        const TargetSpace target = soundness::target_of(each.cloud);
        const OpenStart start = start_of(target);
        const Network network(start.positions, start.faces);
        EXPECT_EQ(network.validate(), "");
        EXPECT_EQ(network.component_count(), each.components);
        EXPECT_EQ(network.genus(), each.genus);
        EXPECT_EQ(network.boundary_loop_count(), each.loops);
        EXPECT_EQ(start.components, each.components);
        EXPECT_EQ(start.genus, each.genus);
        EXPECT_EQ(start.loops, each.loops);
        EXPECT_TRUE(start.outliers.empty());
        EXPECT_TRUE(start.warnings.empty());
        EXPECT_LE(network.vertex_count(), 5000) << "half of the default target";
        EXPECT_LE(static_cast<std::size_t>(network.vertex_count()), each.cloud.size() / 4);
        EXPECT_LT(farthest(start, target), 0.02);
    }
}

TEST(OpenStart, IsSmallWhereFewVerticesAreWanted) {
    OpenStartOptions options;
    options.wanted_vertices = 40;
    options.target_vertices = 20;
    const OpenStart start = start_of(shapes::plane_cloud(3000), options);
    EXPECT_LE(start.positions.size(), 40U);
    EXPECT_GT(start.positions.size(), 20U);
    EXPECT_EQ(start.fewest_vertices, 20);
    EXPECT_EQ(start.loops, 1);
}

TEST(OpenStart, TurnsItsConvexSideOutward) {
    const Cloud cap =
        open_shapes::cut(shapes::sphere_cloud(20000), [](const vcg::Point3d& p) { return p[2] > 0.3; });
    const OpenStart start = start_of(cap);
    std::size_t outward = 0;
    for (const Triangle& f : start.faces) {
        const auto at = [&](std::size_t k) { return start.positions[static_cast<std::size_t>(f[k])]; };
        outward += ((at(1) - at(0)) ^ (at(2) - at(0)))[2] > 0 ? 1 : 0;
    }
    EXPECT_GT(outward, start.faces.size() * 98 / 100);
}

TEST(OpenStart, ClosesHolesUpToTheDiameterAskedFor) {
    const Case holed = open_shapes::cases()[6];
    OpenStartOptions options;
    options.close_holes_up_to = 0.25;  // the holes' diameter is .24 / sqrt(2), about .17
    EXPECT_EQ(start_of(holed.cloud, options).loops, 1);
    options.close_holes_up_to = 0.1;
    EXPECT_EQ(start_of(holed.cloud, options).loops, 3);
    options.close_holes_up_to = 0;
    EXPECT_EQ(start_of(holed.cloud, options).loops, 3);
}

TEST(OpenStart, FollowsTheDensityOfTheCloud) {
    // A square of ten times as many points on one half as on the other.
    Random random(1);
    const Cloud cloud = open_shapes::cut(
        shapes::plane_cloud(60000), [&](const vcg::Point3d& p) { return p[0] < 0 || random.below(10) == 0; });
    const OpenStart start = start_of(cloud);
    EXPECT_EQ(start.components, 1);
    EXPECT_EQ(start.loops, 1);
    EXPECT_NEAR(area(start), 0.5, 0.05);
}

TEST(OpenStart, CutsAMoebiusStripAndSaysWhere) {
    const OpenStart start = start_of(open_shapes::band(10000, 1));
    EXPECT_EQ(Network(start.positions, start.faces).validate(), "");
    EXPECT_EQ(start.components, 1);
    EXPECT_EQ(start.loops, 1);
    EXPECT_EQ(start.genus, 0);  // a disc
    EXPECT_TRUE(warns(start, "cut there, near ("));
}

TEST(OpenStart, LeavesOutSpecks) {
    Cloud cloud = shapes::plane_cloud(5000);
    for (int i = 0; i < 30; ++i) cloud.emplace_back(0.01 * (i % 6), 0.01 * (i / 6), 0.6);
    const OpenStart start = start_of(cloud);
    EXPECT_EQ(start.components, 1);
    ASSERT_EQ(start.outliers.size(), cloud.size());
    EXPECT_EQ(std::count(start.outliers.begin(), start.outliers.end(), 1), 30);
    EXPECT_EQ(std::count(start.outliers.end() - 30, start.outliers.end(), 1), 30);
    EXPECT_TRUE(warns(start, "30 of 5030 points (0.6 %) show no surface"));
}

TEST(OpenStart, SaysIfItMissesTheNarrowSidesOfASlab) {
    EXPECT_TRUE(start_of(shapes::box_cloud(3000, {1, 0.7, 0.1})).misses_surface);
    EXPECT_FALSE(start_of(shapes::box_cloud(12000, {1, 0.7, 0.1})).misses_surface);
    EXPECT_FALSE(start_of(shapes::plane_cloud(5000)).misses_surface);
}

TEST(OpenStart, RefusesWhatIsNoSurface) {
    const auto refusal = [](const Cloud& cloud) -> std::string {
        try {
            start_of(cloud);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    Cloud scattered;
    Random random(1);
    for (int i = 0; i < 5000; ++i) scattered.push_back(shapes::in_cube(random));
    EXPECT_NE(refusal(scattered).find("scattered"), std::string::npos);
    EXPECT_NE(refusal(open_shapes::helix(2000)).find("on curves"), std::string::npos);
    EXPECT_NE(refusal(shapes::plane_cloud(99)).find("too few"), std::string::npos);
}

TEST(OpenStart, KeepsASmallSheetButNoClump) {
    // Half a sphere, and apart from it .7 % of the points: on a small square, or in a ball.
    Cloud half =
        open_shapes::cut(shapes::sphere_cloud(40000), [](const vcg::Point3d& p) { return p[2] < 0; });
    Cloud sheet = half, clump = half;
    Random random(1);
    for (const vcg::Point3d& p : shapes::plane_cloud(140)) sheet.push_back(p * 0.3 + vcg::Point3d(0, 0, 1));
    for (int i = 0; i < 140; ++i) clump.push_back(shapes::in_ball(random) * 0.05 + vcg::Point3d(0, 0, 1));
    EXPECT_EQ(start_of(sheet).components, 2);
    EXPECT_TRUE(start_of(sheet).outliers.empty());
    EXPECT_EQ(start_of(clump).components, 1);
    OpenStartOptions few;
    few.target_vertices = 40;  // of which the square would get a quarter of one
    EXPECT_EQ(start_of(sheet, few).components, 1);
}

TEST(OpenStart, KeepsASmallSheetUnderNoise) {
    // Noise about as wide as the points are apart, on half a sphere and on a square with .7 % of the points.
    Cloud sheet =
        open_shapes::cut(shapes::sphere_cloud(200000, 0.007), [](const vcg::Point3d& p) { return p[2] < 0; });
    Random random(2);
    for (const vcg::Point3d& p : shapes::plane_cloud(700))
        sheet.push_back(p * 0.2 + vcg::Point3d(0, 0, 1 + 0.007 * shapes::signed_unit(random)));
    EXPECT_EQ(start_of(sheet).components, 2);
}

}  // namespace
}  // namespace neuralmesh
