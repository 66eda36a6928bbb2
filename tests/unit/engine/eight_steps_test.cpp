// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Eight Basic Steps at a time against the reference, which takes them one by one.
#include "vcg_core/engine/eight_steps.h"

#include "tests/unit/reference/reference_learner.h"
#include "tests/unit/support/referee.h"

namespace neuralmesh::eight_steps_test {

using reference::basic_step;
using reference::BasicStep;
using reference::Positions;

/// Float rounding in a frame of diagonal 1, over some ten smoothing steps.
constexpr double kTolerance = 1e-6;

struct Case {
    const char* name;
    Shape shape;
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
                             {"half disk", shapes::fan(14)},
                             {"stars of three", shapes::tetrahedron()}};
    Random random(1);
    for (Case& c : result)
        for (vcg::Point3d& p : c.shape.positions) p = p * 0.28 + shapes::in_ball(random) * 0.02;
    return result;
}

/// Per lane: the normal of the winner before and after, and the displacements of the winner and its ring.
struct Steps {
    EightVectors normal;
    EightVectors normal_after;
    Four moved[EightSteps::kLanes][16];
};

void take(const Network& network, const std::vector<VertexId>& winners,
          const std::vector<vcg::Point3f>& signals, const StepRates& rates, EightSteps& eight, Steps& steps) {
    vcg::Point3f towards[EightSteps::kLanes];
    std::copy(signals.begin(), signals.end(), towards);
    eight.gather(network, winners.data(), static_cast<int>(winners.size()));
    eight.normals(steps.normal);
    eight.move_winners(towards, rates.learning_rate);
    eight.smooth(rates.smoothing_steps, rates.smoothing_rate);
    eight.normals(steps.normal_after);
    Four* to[EightSteps::kLanes];
    for (int lane = 0; lane < EightSteps::kLanes; ++lane) to[lane] = steps.moved[lane];
    eight.displacements(to);
}

vcg::Point3d lane_of(const EightVectors& v, int lane) {
    return vcg::Point3d::Construct(vcg::Point3f(v.x[lane], v.y[lane], v.z[lane]));
}

vcg::Point3d point_of(const Four& v) { return vcg::Point3d::Construct(vcg::Point3f(v[0], v[1], v[2])); }

/// Up to \p count vertices with the valence of \p first, from all over the mesh.
std::vector<VertexId> winners_like(const Network& network, VertexId first, std::size_t count) {
    std::vector<VertexId> result;
    for (VertexId i = 0; i < network.slot_count() && result.size() < count; ++i) {
        const VertexId v = (first + 7 * i) % network.slot_count();
        if (network.ring(v).valence == network.ring(first).valence) result.push_back(v);
    }
    return result;
}

void expect_step(const BasicStep& expected, const Steps& steps, int lane, const Network& network,
                 const Positions& before) {
    const Ring& ring = network.ring(expected.winner);
    const auto expect_moved = [&](VertexId v, const vcg::Point3d& to, const Four& by) {
        EXPECT_LT((point_of(by) - (to - before[v])).Norm(), kTolerance) << "vertex " << v;
    };
    expect_moved(expected.winner, expected.winner_position, steps.moved[lane][0]);
    for (int i = 0; i < ring.valence; ++i)
        expect_moved(ring[i], expected.ring_positions[static_cast<std::size_t>(i)], steps.moved[lane][1 + i]);
    const vcg::Point3d turn = lane_of(steps.normal_after, lane) - lane_of(steps.normal, lane);
    EXPECT_NEAR(turn.SquaredNorm() / 2, expected.delta, 1e-5 * (1 + std::sqrt(expected.delta)));
    EXPECT_NEAR(lane_of(steps.normal, lane).Norm(), 1, 1e-5);
}

TEST(EightSteps, AreBasicSteps) {
    Random random(2);
    EightSteps eight;  // reused, as in a run
    Steps steps;
    for (const Case& c : cases()) {
        const Network network = network_of(c.shape);
        const Positions before = reference::exact_positions_of(network);
        for (VertexId first = 0; first < network.slot_count(); ++first) {
            for (const int smoothing_steps : {0, 1, 2, 5, 10}) {
                SCOPED_TRACE(testing::Message()
                             << c.name << ", winner " << first << ", smoothing steps " << smoothing_steps);
                const StepRates rates{0.06F, 0.2F, smoothing_steps};
                const auto winners = winners_like(network, first, 1 + random.below(EightSteps::kLanes));
                std::vector<vcg::Point3f> signals;
                for (const VertexId w : winners)
                    signals.push_back(network.position(w) +
                                      vcg::Point3f::Construct(shapes::in_ball(random) * 0.05));
                take(network, winners, signals, rates, eight, steps);
                ASSERT_EQ(eight.valence(), network.ring(first).valence);
                for (std::size_t lane = 0; lane < winners.size(); ++lane)
                    expect_step(basic_step(network, before, winners[lane],
                                           vcg::Point3d::Construct(signals[lane]), rates),
                                steps, static_cast<int>(lane), network, before);
            }
        }
    }
}

TEST(EightSteps, StayFiniteWhereTheMeshHasNoArea) {
    for (Shape shape :
         {shapes::tetrahedron(), shapes::icosphere(1), shapes::grid(4, 4), shapes::bipyramid(15)}) {
        for (const double scale : {0.0, 1e-30, 1e-20, 1e-12, 1e-6}) {
            for (vcg::Point3d& p : shape.positions) p = vcg::Point3d(p[0], p[1] * scale, p[2] * scale) * 0.3;
            Network network = network_of(shape);
            EightSteps eight;
            Steps steps;
            for (VertexId w = 0; w < network.slot_count(); ++w) {
                take(network, {w}, {{0.1F, 0, 0}}, {0.06F, 0.05F, 5}, eight, steps);
                EXPECT_LE(lane_of(steps.normal, 0).Norm(), 1.0001);
                const auto move = [&](VertexId v, const Four& by) {
                    network.set_position(v, network.position(v) + vcg::Point3f(by[0], by[1], by[2]));
                };
                move(w, steps.moved[0][0]);
                for (int i = 0; i < eight.valence(); ++i) move(network.ring(w)[i], steps.moved[0][1 + i]);
            }
            EXPECT_EQ(network.validate(), "");
        }
    }
}

}  // namespace neuralmesh::eight_steps_test
