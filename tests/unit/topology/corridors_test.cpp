// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Ways along a tube that keep clear of all points. Its ends are the membranes that would be joined.
#include "vcg_core/topology/corridors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/mesh/boundary_loops.h"

namespace neuralmesh {
namespace {

using targets::network_in_frame;
using targets::target_of;

constexpr int kAround = 24;

/// Points on the side of a tube of radius 1 and height 1; none where \p bare(turn, height), a turn being 1.
template <class Bare>
shapes::Cloud side_without(const Bare& bare, int count = 20000) {
    shapes::Cloud cloud;
    Random random(7);
    for (int i = 0; i < count; ++i) {
        const double turn = static_cast<double>(random.unit()), height = static_cast<double>(random.unit());
        const double angle = 2 * shapes::kPi * turn;
        if (!bare(turn, height)) cloud.emplace_back(std::cos(angle), std::sin(angle), height);
    }
    return cloud;
}

/// A tube that is closed at both ends by faces without points.
struct Tube {
    explicit Tube(const shapes::Cloud& cloud)
        : target(target_of(cloud)),
          network(network_in_frame(target, shapes::tube(kAround, 8))),
          rims(boundary_loops(network.slot_count(), network.faces())),
          surface(closed(network, rims)) {
        Random random(1);
        ThreadTeam team(1);
        support =
            face_signals(network, surface, fair_sample(target, target.positions().size(), random), team);
        ends.assign(surface.face_count(), -1);
        for (int f = 0; f < surface.face_count(); ++f) {
            const Triangle& face = surface.faces[f];
            const auto on = [&](const Rim& rim) {
                return std::all_of(face.begin(), face.end(), [&](VertexId v) {
                    return std::find(rim.begin(), rim.end(), v) != rim.end();
                });
            };
            ends[f] = on(rims[0]) || on(rims[1]) ? 0 : -1;
        }
    }
    static Surface closed(Network& network, const std::vector<Rim>& rims) {
        for (const Rim& rim : rims) {
            const Surface surface(network);
            const PerFace<char> none(surface.face_count(), 0);
            network.exchange_faces({}, closing_patch(rim, surface.positions, {network, surface, none}));
        }
        return Surface(network);
    }
    std::vector<int> faces(bool of_ends) const {
        std::vector<int> found;
        for (int f = 0; f < surface.face_count(); ++f)
            if ((ends[f] == 0) == of_ends) found.push_back(f);
        return found;
    }
    Corridors corridors(const PerFace<int>& membrane_of) const {
        return {surface, support, target.positions(), mean_edge_length(surface), membrane_of};
    }
    /// Both ways.
    bool lead(const PerFace<int>& membrane_of) const {
        const Corridors ways = corridors(membrane_of);
        const bool there = ways.lead(rims[0], rims[1]);
        EXPECT_EQ(there, ways.lead(rims[1], rims[0]));
        return there;
    }

    TargetSpace target;
    Network network;
    std::vector<Rim> rims;
    Surface surface;
    FaceSignals support;
    PerFace<int> ends;  ///< 0: at an end
};

bool nowhere(double /*turn*/, double /*height*/) { return false; }
bool along(double turn, double /*height*/) { return turn > 0.4 && turn < 0.6; }

TEST(Corridors, NoneLeadsAlongATubeWithPointsAllAround) {
    const Tube tube(side_without(nowhere));
    EXPECT_FALSE(tube.lead(tube.ends));
}

TEST(Corridors, OneLeadsAlongAStripWithoutPoints) {
    const Tube tube(side_without(along));
    EXPECT_TRUE(tube.lead(tube.ends));
}

TEST(Corridors, PointsAcrossTheStripEndIt) {
    const Tube tube(side_without(
        [](double turn, double height) { return along(turn, height) && (height < 0.35 || height > 0.65); }));
    EXPECT_FALSE(tube.lead(tube.ends));
}

TEST(Corridors, MayWind) {
    const Tube tube(side_without([](double turn, double height) {
        return (turn > 0.1 && turn < 0.3 && height < 0.6) ||
               (turn > 0.1 && turn < 0.6 && std::abs(height - 0.5) < 0.2) ||
               (turn > 0.4 && turn < 0.6 && height > 0.4);
    }));
    EXPECT_TRUE(tube.lead(tube.ends));
}

TEST(Corridors, DoNotLeadOverFacesThatAreLeftOut) {
    const Tube tube(side_without(along));
    PerFace<int> left_out = tube.ends;
    for (const int f : tube.faces(false)) {
        const auto& s = tube.surface;
        const Vector3 middle = (s.corner(f, 0) + s.corner(f, 1) + s.corner(f, 2)) / 3;
        const vcg::Point3d place = tube.target.frame().outside({middle[0], middle[1], middle[2]});
        if (std::abs(place[2] - 0.5) < 0.1) left_out[f] = 1;
    }
    EXPECT_FALSE(tube.lead(left_out));
}

TEST(Corridors, TheWidestPlaceIsMeasuredInSpacings) {
    const Tube dense(side_without(nowhere)), sparse(side_without(nowhere, 200));
    EXPECT_GE(dense.corridors(dense.ends).widest(dense.faces(true)), 9.9F);
    EXPECT_LT(dense.corridors(dense.ends).widest(dense.faces(false)), 3);
    const float width = sparse.corridors(sparse.ends).widest(sparse.faces(true));
    EXPECT_GT(width, 3);  // the ends are as wide as about five spacings
    EXPECT_LT(width, 9);
}

}  // namespace
}  // namespace neuralmesh
