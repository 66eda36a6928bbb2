// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Start meshes turned by normals.
#include "vcg_core/start/facing.h"

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

TEST(Facing, OfASheetFollowsItsNormals) {
    const Cloud cloud = shapes::plane_cloud(2000);
    const TargetSpace target =
        target_of(cloud, std::vector<PackedNormal>(cloud.size(), packed_point({0, 0, -1})));
    Network network = network_for(target, shapes::grid(10, 10));
    EXPECT_EQ(orient_by_normals(network, target), 1);
    for (const Triangle& f : network.faces()) {
        const auto at = [&](std::size_t k) { return network.position(f[k]); };
        EXPECT_LT(((at(1) - at(0)) ^ (at(2) - at(0)))[2], 0);
    }
}

TEST(Facing, OfAnOpenMeshFollowsMostNormals) {
    const Cloud cloud = bowl(8000);
    for (const bool in : {false, true}) {
        const TargetSpace target = target_of(cloud, flipped(in ? inward(cloud) : outward(cloud), 5));
        Network network = network_for(target, open_shapes::open_sphere());
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
        Network network = network_for(*target, open_shapes::open_sphere());
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
    shapes::Shape both = open_shapes::open_sphere();
    const auto first = static_cast<VertexId>(both.positions.size());
    shapes::append(both, open_shapes::open_sphere(), {3, 0, 0});
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
