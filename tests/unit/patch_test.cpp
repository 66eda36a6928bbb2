// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The gathered, vectorised Basic Step against one that walks over the mesh.
#include "vcg_core/patch.h"

#include <gtest/gtest.h>

#include "referee.h"
#include "reference_learner.h"
#include "shapes.h"

namespace neuralmesh {
namespace {

/// Float rounding in a frame of diagonal 1, over some ten sweeps.
constexpr double kTolerance = 1e-6;

struct Case {
    const char* name;
    shapes::Shape shape;
};

/// Meshes inside the core's frame, shaken so that nothing is symmetric or flat.
std::vector<Case> cases() {
    std::vector<Case> result{{"icosphere", shapes::icosphere(2)},
                             {"torus", shapes::torus_grid(12, 8)},
                             {"disk", shapes::grid(6, 6)},
                             {"tube", shapes::tube(5, 4)},
                             {"valences 15", shapes::bipyramid(15)},
                             {"valences 9", shapes::bipyramid(9)},
                             {"cube", shapes::cube()},
                             {"half disk", shapes::fan(14)}};
    Random random(1);
    for (Case& c : result)
        for (vcg::Point3d& p : c.shape.positions) p = p * 0.28 + shapes::in_ball(random) * 0.02;
    return result;
}

bool has_star_of_three(const Network& network, VertexId w) {
    const Ring& ring = network.ring(w);
    for (int i = 0; i < ring.valence; ++i)
        if (network.ring(ring[i]).valence == 3 && network.ring(ring[i]).open == 0) return true;
    return false;
}

TEST(Patch, IsTheStepWalkedOverTheMesh) {
    Random random(2);
    for (const Case& c : cases()) {
        const Network network = referee::network_of(c.shape);
        Patch patch;  // reused, as the learner does
        for (VertexId w = 0; w < network.slot_count(); ++w) {
            for (const int sweeps : {0, 1, 2, 5, 10}) {
                SCOPED_TRACE(testing::Message() << c.name << ", winner " << w << ", sweeps " << sweeps);
                Settings settings;
                settings.smoothing_steps = sweeps;
                settings.smoothing_rate = 0.2;
                const vcg::Point3d s =
                    vcg::Point3d::Construct(network.position(w)) + shapes::in_ball(random) * 0.05;
                reference::Positions expected = reference::positions_of(network);
                patch.gather(network, w);
                EXPECT_LT((vcg::Point3d::Construct(patch.normal()) - reference::normal(network, expected, w))
                              .Norm(),
                          1e-5);
                reference::basic_step(network, expected, w, s, settings);
                patch.move_winner(vcg::Point3f::Construct(s), 0.06F);
                patch.smooth(sweeps, 0.2F);

                ASSERT_EQ(patch.winner(), w);
                ASSERT_EQ(patch.valence(), network.ring(w).valence);
                EXPECT_LT(
                    (vcg::Point3d::Construct(patch.winner_position()) - reference::at(expected, w)).Norm(),
                    kTolerance);
                for (int i = 0; i < patch.valence(); ++i) {
                    ASSERT_EQ(patch.neighbour(i), network.ring(w)[i]);
                    EXPECT_LT((vcg::Point3d::Construct(patch.position(i)) -
                               reference::at(expected, patch.neighbour(i)))
                                  .Norm(),
                              kTolerance);
                }
                EXPECT_LT((vcg::Point3d::Construct(patch.normal()) - reference::normal(network, expected, w))
                              .Norm(),
                          1e-5);
            }
        }
    }
}

TEST(Patch, SmoothsStarsOfThree) {
    shapes::Shape shape = shapes::tetrahedron();
    for (vcg::Point3d& p : shape.positions) p *= 0.1;
    const Network network = referee::network_of(shape);
    ASSERT_TRUE(has_star_of_three(network, 0));
    Settings settings;
    reference::Positions expected = reference::positions_of(network);
    reference::basic_step(network, expected, 0, {0.3, 0.1, 0.2}, settings);
    Patch patch;
    patch.gather(network, 0);
    patch.move_winner({0.3F, 0.1F, 0.2F}, 0.06F);
    patch.smooth(5, 0.05F);
    for (int i = 0; i < 3; ++i)
        EXPECT_LT(
            (vcg::Point3d::Construct(patch.position(i)) - reference::at(expected, patch.neighbour(i))).Norm(),
            kTolerance);
}

TEST(Patch, LeavesBoundaryVerticesWhereTheyAre) {
    const Network network = referee::network_of(cases()[2].shape);
    Patch patch;
    for (VertexId w = 0; w < network.slot_count(); ++w) {
        patch.gather(network, w);
        patch.move_winner({0.1F, 0.1F, 0.1F}, 0.5F);
        patch.smooth(10, 0.5F);
        for (int i = 0; i < patch.valence(); ++i) {
            if (network.ring(patch.neighbour(i)).open == 0) continue;
            EXPECT_LT((patch.position(i) - network.position(patch.neighbour(i))).Norm(), 1e-7F);
        }
    }
}

TEST(Patch, DoesNotLeaveAPlane) {
    const Network network = referee::network_of(shapes::grid(8, 8));
    Patch patch;
    for (VertexId w = 0; w < network.slot_count(); ++w) {
        patch.gather(network, w);
        patch.move_winner({0.03F, -0.1F, 0}, 0.3F);
        patch.smooth(20, 0.3F);
        EXPECT_EQ(patch.winner_position()[2], 0);
        for (int i = 0; i < patch.valence(); ++i) EXPECT_EQ(patch.position(i)[2], 0);
    }
}

TEST(Patch, StaysFiniteWhereTheMeshHasNoArea) {
    for (shapes::Shape shape :
         {shapes::tetrahedron(), shapes::icosphere(1), shapes::grid(4, 4), shapes::bipyramid(15)}) {
        for (const double scale : {0.0, 1e-30, 1e-20, 1e-12, 1e-6}) {
            for (vcg::Point3d& p : shape.positions) p = vcg::Point3d(p[0], p[1] * scale, p[2] * scale) * 0.3;
            Network network = referee::network_of(shape);
            Patch patch;
            for (VertexId w = 0; w < network.slot_count(); ++w) {
                patch.gather(network, w);
                EXPECT_LE(patch.normal().Norm(), 1.0001F);
                patch.move_winner({0.1F, 0, 0}, 0.06F);
                patch.smooth(5, 0.05F);
                for (int i = 0; i < patch.valence(); ++i)
                    network.set_position(patch.neighbour(i), patch.position(i));
                network.set_position(w, patch.winner_position());
            }
            EXPECT_EQ(network.validate(), "");
        }
    }
}

}  // namespace
}  // namespace neuralmesh
