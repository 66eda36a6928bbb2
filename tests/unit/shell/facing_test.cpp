// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Start meshes turned by normals.
#include "vcg_core/shell/facing.h"

#include <gtest/gtest.h>

#include "tests/unit/support/normal_clouds.h"

namespace neuralmesh {
namespace {

using namespace normal_clouds;

Network network_for(const TargetSpace& target, const shapes::Shape& shape) {
    return targets::network_in_frame(target, shape);
}

/// Twice the signed volume of the fans from the origin of the input: positive if it faces away from there.
double facing_away(const Network& network, const TargetSpace& target, VertexId first, VertexId end) {
    double sum = 0;
    for (const Triangle& f : network.faces()) {
        if (f[0] < first || f[0] >= end) continue;
        const auto at = [&](int k) {
            return target.frame().outside(network.position(f[static_cast<std::size_t>(k)]));
        };
        sum += at(0) * (at(1) ^ at(2));
    }
    return sum;
}

/// The part of a sphere below .3, with one boundary.
shapes::Shape open_sphere() {
    shapes::Shape sphere = shapes::icosphere(3);
    shapes::Shape open{sphere.positions, {}};
    std::vector<int> moved(sphere.positions.size(), -1);
    open.positions.clear();
    for (const auto& f : sphere.faces) {
        const auto z = [&](std::size_t k) { return sphere.positions[static_cast<std::size_t>(f[k])][2]; };
        if (z(0) > 0.3 || z(1) > 0.3 || z(2) > 0.3) continue;
        open.faces.push_back(f);
        for (int& v : open.faces.back()) {
            int& to = moved[static_cast<std::size_t>(v)];
            if (to < 0) {
                to = static_cast<int>(open.positions.size());
                open.positions.push_back(sphere.positions[static_cast<std::size_t>(v)]);
            }
            v = to;
        }
    }
    return open;
}

/// The share of the faces that are turned to \p viewpoint; with \p far the direction of one.
double turned_to(const Network& network, const vcg::Point3f& viewpoint, bool far = false) {
    int count = 0;
    for (const Triangle& f : network.faces()) {
        const auto at = [&](std::size_t k) { return network.position(f[k]); };
        const vcg::Point3f sight = far ? viewpoint : viewpoint - (at(0) + at(1) + at(2)) / 3;
        count += ((at(1) - at(0)) ^ (at(2) - at(0))) * sight > 0 ? 1 : 0;
    }
    return static_cast<double>(count) / network.face_count();
}

/// \p shape as a network that faces one side or the other, after learning has moved each vertex by up to \p
/// noise.
Network either_way(shapes::Shape shape, bool over, double noise = 0) {
    if (over)
        for (auto& f : shape.faces) std::swap(f[1], f[2]);
    return referee::network_of(shape, noise);
}

const vcg::Point3f kFarAway(2000, 50000, 3);

/// A square, turned about the x axis by so many degrees.
shapes::Shape tilted(double degrees) {
    const double turn = degrees * shapes::kPi / 180;
    shapes::Shape sheet = shapes::grid(30, 30);
    for (vcg::Point3d& p : sheet.positions) p = {p[0], p[1] * std::cos(turn), p[1] * std::sin(turn)};
    return sheet;
}

struct Sheet {
    double tilt, noise;
};

class FacingOfSheets : public testing::TestWithParam<Sheet> {};

TEST_P(FacingOfSheets, IsUp) {
    for (const bool over : {false, true}) {
        Network network = either_way(tilted(GetParam().tilt), over, GetParam().noise);
        orient_convex_side_outward(network);
        orient_to_viewer(network, kFarAway);
        EXPECT_GT(turned_to(network, {0, 0, 1}, true), 0.85);
        EXPECT_EQ(network.validate(), "");
    }
}

INSTANTIATE_TEST_SUITE_P(TiltsAndNoise, FacingOfSheets,
                         testing::Values(Sheet{0, 0}, Sheet{0, 0.01}, Sheet{30, 0}, Sheet{30, 0.01},
                                         Sheet{60, 0}, Sheet{60, 0.005}, Sheet{85, 0}));

/// What a sensor at the origin sees along z, \p distance away, with two more squares to the sides of the
/// first and half as far again behind it. From above, which is along z as well, all are single-valued, too.
shapes::Shape frame(double distance) {
    shapes::Shape seen;
    for (const double side : {-1.0, 0.0, 1.0})
        shapes::append(seen, shapes::grid(10, 10), {side, 0, distance * (side == 0 ? 1 : 1.5)});
    return seen;
}

TEST(Facing, OfAFrameInItsSensorsCoordinatesIsToTheSensor) {
    for (const double distance : {1.0, 5.0})
        for (const bool over : {false, true}) {
            Network network = either_way(frame(distance), over);
            orient_to_viewer(network, {0, 0, 0});
            EXPECT_EQ(turned_to(network, {0, 0, 0}), 1) << distance;
            EXPECT_EQ(network.validate(), "");
        }
}

TEST(Facing, IsUpWhereTheOriginIsNoSensor) {
    const shapes::Shape sheet = tilted(10);
    // Among the points, beside them, and as far away as that of a country's coordinates.
    for (const vcg::Point3f& origin :
         {vcg::Point3f(0, 0, 0), vcg::Point3f(0, 0, -0.1F), vcg::Point3f(0, 0, -30)})
        for (const bool over : {false, true}) {
            Network network = either_way(sheet, over);
            orient_to_viewer(network, origin);
            EXPECT_EQ(turned_to(network, {0, 0, 1}, true), 1);
        }
}

TEST(Facing, StaysWhereNobodySeesAllOfTheSurface) {
    for (const shapes::Shape& shape : {open_sphere(), shapes::tube(24, 8), shapes::icosphere(2)})
        for (const vcg::Point3f& origin : {vcg::Point3f(0, 0, 0), vcg::Point3f(0, -5, 0.5F), kFarAway})
            for (const bool over : {false, true}) {
                Network network = either_way(shape, over);
                const auto faces = network.faces();
                orient_to_viewer(network, origin);
                EXPECT_EQ(network.faces(), faces);
            }
}

TEST(Facing, OfASheetFollowsItsNormalsFirst) {
    const Cloud cloud = shapes::plane_cloud(2000);
    const TargetSpace target =
        target_of(cloud, std::vector<PackedNormal>(cloud.size(), packed_point({0, 0, -1})));
    Network network = network_for(target, shapes::grid(10, 10));
    orient_to_viewer(network, kFarAway);
    EXPECT_EQ(orient_by_normals(network, target), 1);
    EXPECT_EQ(turned_to(network, {0, 0, 1}, true), 0);
}

TEST(Facing, OfAnOpenMeshFollowsMostNormals) {
    const Cloud cloud = bowl(8000);
    for (const bool in : {false, true}) {
        const TargetSpace target = target_of(cloud, flipped(in ? inward(cloud) : outward(cloud), 5));
        Network network = network_for(target, open_sphere());
        ASSERT_EQ(network.boundary_loop_count(), 1);
        orient_convex_side_outward(network);
        EXPECT_GT(facing_away(network, target, 0, network.slot_count()), 0);
        const FacingVote before = facing_votes(network, target).front();
        EXPECT_NEAR(before.share_along(), in ? 0.2 : 0.8, 0.05);
        EXPECT_EQ(orient_by_normals(network, target), 1);
        EXPECT_EQ(facing_away(network, target, 0, network.slot_count()) < 0, in);
        EXPECT_NEAR(facing_votes(network, target).front().share_along(), 0.8, 0.05);
        EXPECT_EQ(network.validate(), "");
    }
}

TEST(Facing, OfAnOpenMeshStaysWhereNormalsDisagreeOrAreMissing) {
    const Cloud cloud = bowl(8000);
    const TargetSpace disagreeing = target_of(cloud, flipped(inward(cloud), 2));
    const TargetSpace without = targets::target_of(cloud);
    for (const TargetSpace* target : {&disagreeing, &without}) {
        Network network = network_for(*target, open_sphere());
        const auto faces = network.faces();
        EXPECT_EQ(orient_by_normals(network, *target), 0);
        EXPECT_EQ(network.faces(), faces);
    }
}

TEST(Facing, OfClosedComponentsStays) {
    const Cloud cloud = shapes::sphere_cloud(8000);
    const TargetSpace target = target_of(cloud, inward(cloud));
    Network network = network_for(target, shapes::icosphere(2));
    const auto faces = network.faces();
    EXPECT_EQ(facing_votes(network, target).front().along, 0);
    EXPECT_TRUE(facing_votes(network, target).front().is_clear());
    EXPECT_EQ(orient_by_normals(network, target), 0);
    EXPECT_EQ(network.faces(), faces);
}

TEST(Facing, OfEveryComponentIsItsOwn) {
    // Two bowls side by side, whose normals point in and out.
    shapes::Shape both = open_sphere();
    const auto first = static_cast<VertexId>(both.positions.size());
    shapes::append(both, open_sphere(), {3, 0, 0});
    Cloud cloud = bowl(8000);
    std::vector<PackedNormal> normals = outward(cloud);
    for (const vcg::Point3d& p : bowl(8000)) {
        cloud.push_back(p + vcg::Point3d(3, 0, 0));
        normals.push_back(opposite(packed_point(p)));
    }
    const TargetSpace target = target_of(cloud, normals);
    Network network = network_for(target, both);
    EXPECT_EQ(orient_by_normals(network, target), 2);
    const std::vector<FacingVote> votes = facing_votes(network, target);
    ASSERT_EQ(votes.size(), 2U);
    for (const FacingVote& vote : votes) EXPECT_GT(vote.share_along(), 0.99);
    EXPECT_GT(facing_away(network, target, 0, first), 0);
    EXPECT_EQ(network.validate(), "");
}

}  // namespace
}  // namespace neuralmesh
