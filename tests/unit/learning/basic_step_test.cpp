// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Basic Step by hand, on stars simple enough for that.
#include "tests/unit/reference/basic_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/reference/reference_learner.h"
#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

using reference::basic_step;
using reference::BasicStep;
using reference::find_winner;
using reference::Positions;

TEST(BasicStep, MovesTheWinnerByEquation1AndSmoothsItsRing) {
    // The middle of a flat grid of unit squares.
    const Network network = referee::network_of(shapes::grid(4, 4));
    const Positions positions = reference::positions_of(network);
    const VertexId w = find_winner(network, positions, {0.01, 0.02, 0});
    const vcg::Point3d s = positions[w] + vcg::Point3d(0.1, 0, 0.5);
    const BasicStep step = basic_step(network, positions, w, s, {0.25F, 0.5F, 1});
    EXPECT_NEAR((step.winner_position - positions[w] - vcg::Point3d(0.025, 0, 0.125)).Norm(), 0, 1e-12);
    const Ring& ring = network.ring(w);
    for (int i = 0; i < ring.valence; ++i) {
        const VertexId v = ring[i];
        const vcg::Point3d moved = step.ring_positions[static_cast<std::size_t>(i)] - positions[v];
        if (network.ring(v).open != 0) {
            EXPECT_EQ(moved.Norm(), 0);
            continue;
        }
        vcg::Point3d l = -positions[v];
        vcg::Point3d n(0, 0, 0);
        const auto at = [&](VertexId x) { return x == w ? step.winner_position : positions[x]; };
        const Ring& star = network.ring(v);
        for (int j = 0; j < star.valence; ++j) {
            l += at(star[j]) / star.valence;
            n += at(star[j]) ^ at(star.next(j));
        }
        n.Normalize();
        EXPECT_NEAR((moved - (l - n * (l * n)) * 0.5).Norm(), 0, 1e-12) << v;
        EXPECT_GT(moved.Norm(), 1e-4);
    }
}

TEST(BasicStep, HasADeltaOfOneMinusTheCosineOfTheTurn) {
    shapes::Shape shape = shapes::bipyramid(4);
    const Network network = referee::network_of(shape);
    const Positions positions = reference::positions_of(network);
    const VertexId w = 0;
    // Only the winner moves: its normal before and after follows from its four faces.
    const vcg::Point3d s = positions[w] + vcg::Point3d(0.3, -0.2, 0.1);
    const BasicStep step = basic_step(network, positions, w, s, {1, 0.1F, 0});
    EXPECT_EQ(step.winner_position, s);
    const auto normal = [&](const vcg::Point3d& p) {
        vcg::Point3d sum(0, 0, 0);
        const Ring& ring = network.ring(w);
        for (int i = 0; i < ring.valence; ++i) {
            vcg::Point3d n = (positions[ring[i]] - p) ^ (positions[ring.next(i)] - p);
            sum += n.Normalize();
        }
        return sum.Normalize();
    };
    EXPECT_GT(step.delta, 1e-3);
    EXPECT_NEAR(step.delta, 1 - normal(positions[w]) * normal(s), 1e-12);
}

TEST(BasicStep, FindsTheNearestVertexAndTheSmallestIdAmongEquals) {
    const Network network = referee::network_of(shapes::icosphere(2));
    const Positions positions = reference::positions_of(network);
    for (const VertexId v : network.vertices())
        EXPECT_EQ(find_winner(network, positions, positions[v] * 1.01), v);
    const Positions same(network.slot_count(), vcg::Point3d(1, 2, 3));
    EXPECT_EQ(find_winner(network, same, {0, 0, 0}), 0);
}

}  // namespace
}  // namespace neuralmesh
