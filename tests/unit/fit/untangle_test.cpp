// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Self-crossings are smoothed out before the fit, and the fit makes none.
#include "vcg_core/fit/sound_meshes.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tests/unit/support/crumpled.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/fit/fit.h"
#include "vcg_core/fit/move_limits.h"

namespace neuralmesh {
namespace {

using shapes::Shape;

/// The crossings that untangle() leaves.
std::vector<SelfCrossing> smoothed_out(Network& network, int threads) {
    ThreadTeam team(threads);
    NoProgress progress;
    return *untangle(network, team, progress);
}

TEST(CrossingGuard, ObjectsToNewCrossingsIfMoreFacesCross) {
    const SelfCrossing a{0, 1, 2, 3, 4, 5};
    const SelfCrossing b{6, 7, 8, 9, 10, 11};
    CrossingGuard strict;
    EXPECT_TRUE(strict.objections({}).empty());
    EXPECT_EQ(strict.objections({a}), std::vector<VertexId>(a.begin(), a.end()));
    CrossingGuard guard({a});
    EXPECT_TRUE(guard.objections({b}).empty()) << "as many faces as before";
    EXPECT_EQ(guard.objections({a, b}), std::vector<VertexId>(a.begin(), a.end()));
    EXPECT_TRUE(guard.objections({}).empty());
}

TEST(Untangle, SmoothsOutACrumpledCap) {
    Network network = crumpled_sphere(0);
    const Network crumpled = crumpled_sphere(0.13);
    for (VertexId v = 0; v < network.slot_count(); ++v)
        if (network.position(v)[2] > 8) network.set_position(v, crumpled.position(v));
    const Network before = network;
    const std::set<Triangle> faces = cut_faces(network);
    ASSERT_FALSE(faces.empty());
    EXPECT_TRUE(smoothed_out(network, 1).empty());
    EXPECT_TRUE(cut_faces(network).empty());
    EXPECT_EQ(network.validate(), "");
    int moved = 0;
    for (VertexId u = 0; u < network.slot_count(); ++u)
        moved += network.position(u) == before.position(u) ? 0 : 1;
    EXPECT_GT(moved, 0);
    EXPECT_LT(moved, 200) << "vertices far from the cap do not move";
}

TEST(Untangle, SmoothsOutARimThatCutsItself) {
    Network network = referee::network_of(shapes::grid(8, 8));
    // A boundary edge is drawn inwards, one end above the sheet and the other below.
    VertexId a = 0;
    while (network.ring(a).open == 0 || network.ring(a).valence < 4) ++a;
    const VertexId b = network.ring(a)[0];
    network.set_position(a, network.position(a) * 0.5F + vcg::Point3f(0, 0, 0.12F));
    network.set_position(b, network.position(b) * 0.5F - vcg::Point3f(0, 0, 0.12F));
    ASSERT_FALSE(cut_faces(network).empty());
    EXPECT_TRUE(smoothed_out(network, 1).empty());
    EXPECT_TRUE(cut_faces(network).empty());
}

TEST(Untangle, AddsNoCrossingsWhereSmoothingFails) {
    for (const double noise : {0.6, 1.5}) {
        Network network = crumpled_sphere(noise);
        const Network before = network;
        const std::size_t crossings_before = crossings(Surface(network), 1).size();
        EXPECT_LE(smoothed_out(network, 1).size(), crossings_before);
        Network again = before;
        smoothed_out(again, 3);
        for (VertexId v = 0; v < network.slot_count(); ++v) EXPECT_EQ(network.position(v), again.position(v));
    }
}

bool same_positions(const Network& a, const Network& b) {
    for (VertexId v = 0; v < a.slot_count(); ++v)
        if (a.position(v) != b.position(v)) return false;
    return true;
}

TEST(Untangle, GivesUpIfEveryFaceIsNearManyOthers) {
    // Corners anywhere in a ball: every face is near half of the others.
    Network network = crumpled_sphere(0);
    Random random(4);
    for (VertexId v = 0; v < network.slot_count(); ++v)
        network.set_position(v, vcg::Point3f::Construct(shapes::in_ball(random)));
    const Network before = network;
    ThreadTeam team(1);
    NoProgress progress;
    EXPECT_EQ(*untangle(network, team, progress), crossings(Surface(before), 1));
    EXPECT_TRUE(same_positions(network, before));
}

/// A plate 1 x 1 x \p thickness.
shapes::Cloud plate_cloud(int count, double thickness) {
    shapes::Cloud cloud = shapes::box_cloud(count);
    for (vcg::Point3d& p : cloud) p[2] *= thickness;
    return cloud;
}

// Faces much larger than the plate is thick: points of either side are next to faces of the other.
TEST(Fit, DoesNotMakeAPlateCutItself) {
    for (const double thickness : {0.02, 0.05, 0.1}) {
        const shapes::Cloud cloud = plate_cloud(20000, thickness);
        const TargetSpace target = targets::target_of(cloud);
        Shape flattened = shapes::icosphere(2);
        for (vcg::Point3d& p : flattened.positions) p = {0.7 * p[0], 0.7 * p[1], 0.8 * thickness * p[2]};
        Network network = targets::network_in_frame(target, flattened);
        ASSERT_TRUE(cut_faces(network).empty());
        NoProgress progress;
        const FitReport report = fit_to_points(network, target, {}, 1, 1, progress);
        EXPECT_TRUE(report.improved);
        EXPECT_TRUE(cut_faces(network).empty()) << thickness;
        EXPECT_EQ(network.validate(), "");
    }
}

TEST(Fit, LeavesNoMoreCrossingsThanThereWere) {
    const shapes::Cloud cloud = plate_cloud(20000, 0.03);
    const TargetSpace target = targets::target_of(cloud);
    Network network = crumpled_sphere(0.12);
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        vcg::Point3f p = network.position(v) * 0.05F;
        p[2] *= 0.06F;
        network.set_position(v, p);
    }
    const std::size_t before = cut_faces(network).size();
    ASSERT_GT(before, 0U);
    NoProgress progress;
    fit_to_points(network, target, {}, 1, 1, progress);
    EXPECT_LE(cut_faces(network).size(), before);
    EXPECT_EQ(network.validate(), "");
}

}  // namespace
}  // namespace neuralmesh
