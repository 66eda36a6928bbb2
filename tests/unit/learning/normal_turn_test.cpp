// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The stop criterion of eq 8: mean turn of the winner's normal.
#include "vcg_core/learning/normal_turn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

constexpr double kOneDegree = 1.523048e-4;  // 1 - cos(1 degree)

TEST(NormalTurn, IsTheAngleOfEqualTurns) {
    NormalTurn turn;
    EXPECT_EQ(turn.degrees(), 0);
    for (int i = 0; i < 100; ++i) turn.add(kOneDegree, 4);
    EXPECT_NEAR(turn.degrees(), 1, 1e-4);
}

TEST(NormalTurn, ForgetsInTenSignalsPerVertex) {
    NormalTurn turn;
    constexpr int kVertices = 3000;
    for (int i = 0; i < 40 * kVertices; ++i) turn.add(kOneDegree, kVertices);
    for (int i = 0; i < 10 * kVertices; ++i) turn.add(0, kVertices);
    EXPECT_NEAR(turn.degrees(), std::sqrt(1 / std::exp(1.0)), 0.01);
}

/// One signal in two hundred contributes nearly all of the sum, as at a sharp tip. A window of 1000 signals
/// would at times hold so few of them that the turn drops to less than half.
TEST(NormalTurn, HasNoDips) {
    NormalTurn turn;
    Random random(5);
    constexpr int kVertices = 4000;
    double least = 1e9;
    for (int i = 0; i < 60 * kVertices; ++i) {
        turn.add(random.below(200) == 0 ? 200 * kOneDegree : 0, kVertices);
        if (i > 20 * kVertices) least = std::min(least, turn.degrees());
    }
    EXPECT_GT(least, 0.9);
}

}  // namespace
}  // namespace neuralmesh
