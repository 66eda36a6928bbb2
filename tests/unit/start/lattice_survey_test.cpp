// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The vote on lists written by hand. Level l stands for the radius sqrt(l), level 0 for half a step, and the
// last level of a list for one step more.
#include "vcg_core/start/lattice_survey.h"

#include <gtest/gtest.h>

#include <cmath>

namespace neuralmesh {
namespace {

TEST(TopologyVote, NothingToVoteOn) { EXPECT_FALSE(persistent_topology({}).found); }

TEST(TopologyVote, ThePersistentTopologyWins) {
    const TopologyVote vote =
        persistent_topology({{1, 1, 3}, {2, 1, 1}, {4, 1, 1}, {8, 1, 1}, {9, 1, 1}, {16, 1, 1}});
    EXPECT_EQ(vote.genus, 1);
    const double genus3 = 1 - 1 / std::sqrt(2.0), genus1 = 1 / std::sqrt(2.0) - 1 / 5.0;
    EXPECT_DOUBLE_EQ(vote.confidence, genus1 / (genus1 + genus3));
    EXPECT_EQ(vote.level, 2);
}

TEST(TopologyVote, SmallerRadiiCountMore) {
    // Genus 2 at radii from 1 to 2, genus 0 from 2 to 6, which is longer.
    const TopologyVote vote = persistent_topology({{1, 1, 2}, {3, 1, 2}, {4, 1, 0}, {25, 1, 0}});
    EXPECT_EQ(vote.genus, 2);
    EXPECT_DOUBLE_EQ(vote.confidence, 0.5 / (0.5 + 1 / 2.0 - 1 / 6.0));
}

TEST(TopologyVote, OccupiedNodesCountAsHalfAStep) {
    const TopologyVote vote = persistent_topology({{0, 1, 5}, {1, 1, 0}, {100, 1, 0}});
    EXPECT_EQ(vote.genus, 5);
    EXPECT_DOUBLE_EQ(vote.confidence, 1 / (1 + 1 - 1 / 11.0));
    EXPECT_EQ(vote.level, 0);
}

TEST(TopologyVote, IsUncertainIfPointsLieInClumps) {
    EXPECT_EQ(persistent_topology({{4, 1, 1}, {16, 1, 1}}).confidence, 1);
    EXPECT_LT(persistent_topology({{9, 1, 1}, {16, 1, 1}}).confidence, 0.5);
}

TEST(LatticeSurvey, PrefersAFinerLatticeThatIsNotUncertain) {
    TopologyVote first, other;
    first.found = true;
    first.confidence = 0.72;
    other.confidence = 0.56;
    EXPECT_TRUE(is_better(other, first, true));
    EXPECT_FALSE(is_better(other, first, false));
    other.confidence = 0.45;
    EXPECT_FALSE(is_better(other, first, true));
    first.confidence = 0.4;
    EXPECT_TRUE(is_better(other, first, true));
    EXPECT_TRUE(is_better(other, first, false));
    first.found = false;
    other.confidence = 0;
    EXPECT_TRUE(is_better(other, first, false));
}

}  // namespace
}  // namespace neuralmesh
