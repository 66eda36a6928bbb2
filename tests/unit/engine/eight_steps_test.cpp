// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The gathered Basic Steps, eight at a time, against one that walks over the mesh.
#include "vcg_core/engine/eight_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/reference/reference_learner.h"
#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"

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

/// Lane by lane: the winner, by what it and its ring move, and its normal before and after.
struct Steps {
    EightVectors normal;
    EightVectors normal_after;
    Four moved[EightSteps::kLanes][16];
};

void take(const Network& network, const std::vector<VertexId>& winners,
          const std::vector<vcg::Point3f>& signals, float alpha_w, int sweeps, float alpha_l,
          EightSteps& patches, Steps& steps) {
    vcg::Point3f towards[EightSteps::kLanes];
    std::copy(signals.begin(), signals.end(), towards);
    patches.gather(network, winners.data(), static_cast<int>(winners.size()));
    patches.take_normals(steps.normal);
    patches.move_winners(towards, alpha_w);
    patches.smooth(sweeps, alpha_l);
    patches.take_normals(steps.normal_after);
    Four* to[EightSteps::kLanes];
    for (int lane = 0; lane < EightSteps::kLanes; ++lane) to[lane] = steps.moved[lane];
    patches.displacements(to);
}

vcg::Point3d lane_of(const EightVectors& v, int lane) {
    return vcg::Point3d::Construct(vcg::Point3f(v.x[lane], v.y[lane], v.z[lane]));
}

vcg::Point3d point_of(const Four& v) { return vcg::Point3d::Construct(vcg::Point3f(v[0], v[1], v[2])); }

/// Winners of one valence, up to eight at a time: from \p first on, wherever they are in the mesh.
std::vector<VertexId> winners_like(const Network& network, VertexId first, std::size_t count) {
    std::vector<VertexId> result;
    for (VertexId i = 0; i < network.slot_count() && result.size() < count; ++i) {
        const VertexId v = (first + 7 * i) % network.slot_count();
        if (network.ring(v).valence == network.ring(first).valence) result.push_back(v);
    }
    return result;
}

TEST(EightSteps, AreTheStepsWalkedOverTheMesh) {
    Random random(2);
    EightSteps patches;  // reused, as the learner does
    Steps steps;
    for (const Case& c : cases()) {
        const Network network = referee::network_of(c.shape);
        for (VertexId first = 0; first < network.slot_count(); ++first) {
            for (const int sweeps : {0, 1, 2, 5, 10}) {
                SCOPED_TRACE(testing::Message() << c.name << ", winner " << first << ", sweeps " << sweeps);
                Settings settings;
                settings.smoothing_steps = sweeps;
                settings.smoothing_rate = 0.2;
                const auto winners = winners_like(network, first, 1 + random.below(EightSteps::kLanes));
                std::vector<vcg::Point3f> signals;
                for (const VertexId w : winners)
                    signals.push_back(network.position(w) +
                                      vcg::Point3f::Construct(shapes::in_ball(random) * 0.05));
                take(network, winners, signals, 0.06F, sweeps, 0.2F, patches, steps);
                ASSERT_EQ(patches.valence(), network.ring(first).valence);
                const reference::Positions before = reference::positions_of(network);
                for (std::size_t lane = 0; lane < winners.size(); ++lane) {
                    const VertexId w = winners[lane];
                    const Ring& ring = network.ring(w);
                    const int l = static_cast<int>(lane);
                    reference::Positions after = before;
                    EXPECT_LT((lane_of(steps.normal, l) - reference::normal(network, after, w)).Norm(), 1e-5);
                    reference::basic_step(network, after, w, vcg::Point3d::Construct(signals[lane]),
                                          settings);
                    const auto expect_moved = [&](VertexId v, const Four& by) {
                        EXPECT_LT(
                            (point_of(by) - (reference::at(after, v) - reference::at(before, v))).Norm(),
                            kTolerance)
                            << "vertex " << v;
                    };
                    expect_moved(w, steps.moved[lane][0]);
                    for (int i = 0; i < ring.valence; ++i) expect_moved(ring[i], steps.moved[lane][1 + i]);
                    EXPECT_LT((lane_of(steps.normal_after, l) - reference::normal(network, after, w)).Norm(),
                              1e-5);
                }
            }
        }
    }
}

TEST(EightSteps, LanesDoNotKnowOfEachOther) {
    const Network network = referee::network_of(cases()[1].shape);
    const auto winners = winners_like(network, 5, EightSteps::kLanes);
    std::vector<vcg::Point3f> signals;
    Random random(8);
    for (const VertexId w : winners)
        signals.push_back(network.position(w) + vcg::Point3f::Construct(shapes::in_ball(random) * 0.05));
    EightSteps patches;
    Steps together;
    Steps alone;
    take(network, winners, signals, 0.06F, 5, 0.05F, patches, together);
    for (std::size_t lane = 0; lane < winners.size(); ++lane) {
        take(network, {winners[lane]}, {signals[lane]}, 0.06F, 5, 0.05F, patches, alone);
        for (int i = 0; i <= network.ring(winners[lane]).valence; ++i)
            for (int k = 0; k < 4; ++k) EXPECT_EQ(together.moved[lane][i][k], alone.moved[0][i][k]);
    }
}

TEST(EightSteps, SmoothStarsOfThree) {
    shapes::Shape shape = shapes::tetrahedron();
    for (vcg::Point3d& p : shape.positions) p *= 0.1;
    const Network network = referee::network_of(shape);
    ASSERT_TRUE(has_star_of_three(network, 0));
    const reference::Positions before = reference::positions_of(network);
    reference::Positions after = before;
    reference::basic_step(network, after, 0, {0.3, 0.1, 0.2}, Settings());
    EightSteps patches;
    Steps steps;
    take(network, {0}, {{0.3F, 0.1F, 0.2F}}, 0.06F, 5, 0.05F, patches, steps);
    for (int i = 0; i < 3; ++i) {
        const VertexId v = network.ring(0)[i];
        EXPECT_LT(
            (point_of(steps.moved[0][1 + i]) - (reference::at(after, v) - reference::at(before, v))).Norm(),
            kTolerance);
    }
}

TEST(EightSteps, LeaveBoundaryVerticesWhereTheyAre) {
    const Network network = referee::network_of(cases()[2].shape);
    EightSteps patches;
    Steps steps;
    for (VertexId w = 0; w < network.slot_count(); ++w) {
        take(network, {w}, {{0.1F, 0.1F, 0.1F}}, 0.5F, 10, 0.5F, patches, steps);
        for (int i = 0; i < patches.valence(); ++i)
            if (network.ring(network.ring(w)[i]).open != 0) {
                EXPECT_EQ(point_of(steps.moved[0][1 + i]).Norm(), 0);
            }
    }
}

TEST(EightSteps, DoNotLeaveAPlane) {
    const Network network = referee::network_of(shapes::grid(8, 8));
    EightSteps patches;
    Steps steps;
    for (VertexId w = 0; w < network.slot_count(); ++w) {
        take(network, {w}, {{0.03F, -0.1F, 0}}, 0.3F, 20, 0.3F, patches, steps);
        for (int i = 0; i <= patches.valence(); ++i) EXPECT_EQ(steps.moved[0][i][2], 0);
    }
}

TEST(EightSteps, StayFiniteWhereTheMeshHasNoArea) {
    for (shapes::Shape shape :
         {shapes::tetrahedron(), shapes::icosphere(1), shapes::grid(4, 4), shapes::bipyramid(15)}) {
        for (const double scale : {0.0, 1e-30, 1e-20, 1e-12, 1e-6}) {
            for (vcg::Point3d& p : shape.positions) p = vcg::Point3d(p[0], p[1] * scale, p[2] * scale) * 0.3;
            Network network = referee::network_of(shape);
            EightSteps patches;
            Steps steps;
            for (VertexId w = 0; w < network.slot_count(); ++w) {
                take(network, {w}, {{0.1F, 0, 0}}, 0.06F, 5, 0.05F, patches, steps);
                EXPECT_LE(lane_of(steps.normal, 0).Norm(), 1.0001);
                const auto move = [&](VertexId v, const Four& by) {
                    network.set_position(v, network.position(v) + vcg::Point3f(by[0], by[1], by[2]));
                };
                move(w, steps.moved[0][0]);
                for (int i = 0; i < patches.valence(); ++i) move(network.ring(w)[i], steps.moved[0][1 + i]);
            }
            EXPECT_EQ(network.validate(), "");
        }
    }
}

}  // namespace
}  // namespace neuralmesh
