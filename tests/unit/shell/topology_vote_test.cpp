// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The vote on tables written by hand. Level l stands for the radius sqrt(l), level 0 for half a step, and the
// last level of a table for one step more.
#include "vcg_core/shell/topology_vote.h"

#include <gtest/gtest.h>

#include <cmath>

namespace neuralmesh {
namespace {

using Table = std::vector<TopologyAt>;

TEST(TopologyVote, NothingToVoteOn) {
    EXPECT_FALSE(persistent_topology({}, {}).found);
    EXPECT_FALSE(persistent_topology({{}, {}}, {1, 1.4}).found);
}

TEST(TopologyVote, OneTopologyHasAllVotes) {
    const TopologyVote vote = persistent_topology({{{1, 2, 3}, {2, 2, 3}, {4, 2, 3}, {5, 2, 3}}}, {0.1});
    EXPECT_TRUE(vote.found);
    EXPECT_EQ(vote.components, 2);
    EXPECT_EQ(vote.genus, 3);
    EXPECT_DOUBLE_EQ(vote.confidence, 1);
    EXPECT_EQ(vote.lattice, 0);
    EXPECT_EQ(vote.levels, (std::vector<int>{1, 2, 4}));  // 5 is beyond twice the smallest radius
    EXPECT_FALSE(vote.grown);
}

TEST(TopologyVote, ThePersistentTopologyWins) {
    const Table table = {{1, 1, 3}, {2, 1, 1}, {4, 1, 1}, {8, 1, 1}, {9, 1, 1}, {16, 1, 1}};
    const TopologyVote vote = persistent_topology({table}, {1});
    EXPECT_EQ(vote.genus, 1);
    const double genus3 = 1 - 1 / std::sqrt(2.0), genus1 = 1 / std::sqrt(2.0) - 1 / 5.0;
    EXPECT_DOUBLE_EQ(vote.confidence, genus1 / (genus1 + genus3));
    EXPECT_EQ(vote.levels, (std::vector<int>{2, 4, 8}));
}

TEST(TopologyVote, SmallerRadiiCountMore) {
    // Genus 2 at radii from 1 to 2, genus 0 from 2 to 6, which is longer.
    const TopologyVote vote = persistent_topology({{{1, 1, 2}, {3, 1, 2}, {4, 1, 0}, {25, 1, 0}}}, {1});
    EXPECT_EQ(vote.genus, 2);
    EXPECT_DOUBLE_EQ(vote.confidence, 0.5 / (0.5 + 1 / 2.0 - 1 / 6.0));
}

TEST(TopologyVote, ComponentsCountLikeHandles) {
    const TopologyVote vote = persistent_topology({{{1, 4, 0}, {2, 1, 0}, {4, 4, 0}, {64, 4, 0}}}, {1});
    EXPECT_EQ(vote.components, 4);
    // Two ranges of one topology: their votes add up, and the one with more votes gives the levels.
    const double first = 1 - 1 / std::sqrt(2.0), second = 1 / 2.0 - 1 / 9.0;
    EXPECT_DOUBLE_EQ(vote.confidence, (first + second) / (1 - 1 / 9.0));
    EXPECT_EQ(vote.levels, (std::vector<int>{4}));
}

TEST(TopologyVote, OccupiedNodesCountAsHalfAStep) {
    const TopologyVote vote = persistent_topology({{{0, 1, 5}, {1, 1, 0}, {100, 1, 0}}}, {1});
    EXPECT_EQ(vote.genus, 5);
    EXPECT_DOUBLE_EQ(vote.confidence, 1 / (1 + 1 - 1 / 11.0));
    EXPECT_EQ(vote.levels, (std::vector<int>{0}));
}

TEST(TopologyVote, LatticesShareTheRadiiTheyBothCover) {
    // Genus 0 at radii from 1 to 3, genus 1 from 2 to 4: from 2 to 3 each has half a vote.
    const TopologyVote vote = persistent_topology({{{1, 1, 0}, {4, 1, 0}}, {{1, 1, 1}}}, {1, 2});
    EXPECT_EQ(vote.genus, 0);
    const double shared = (1 / 2.0 - 1 / 3.0) / 2;
    const double genus0 = 1 - 1 / 2.0 + shared, genus1 = shared + 1 / 3.0 - 1 / 4.0;
    EXPECT_DOUBLE_EQ(vote.confidence, genus0 / (genus0 + genus1));
}

TEST(TopologyVote, AgreementOfLatticesDecides) {
    // On the first lattice genus 7 has most votes; the others agree on genus 1, which it has, too.
    const Table fine = {{1, 1, 7}, {2, 1, 1}, {3, 1, 2}};
    const Table coarse = {{1, 1, 1}, {36, 1, 1}};
    EXPECT_EQ(persistent_topology({fine}, {1}).genus, 7);
    const TopologyVote vote = persistent_topology({fine, coarse, coarse}, {1, 1.4, 2});
    EXPECT_EQ(vote.genus, 1);
    EXPECT_EQ(vote.lattice, 0);  // the finest one that has it
    EXPECT_EQ(vote.levels, (std::vector<int>{2}));
}

TEST(TopologyVote, LatticesWithoutTopologiesDoNotCount) {
    const TopologyVote vote = persistent_topology({{}, {{1, 1, 1}, {2, 1, 1}}}, {1, 1.4});
    EXPECT_TRUE(vote.found);
    EXPECT_EQ(vote.lattice, 1);
    EXPECT_EQ(vote.genus, 1);
    EXPECT_DOUBLE_EQ(vote.confidence, 1);
}

TEST(TopologyVote, DoesNotDependOnTheUnit) {
    const std::vector<Table> tables = {{{1, 1, 7}, {2, 1, 1}, {3, 1, 2}}, {{1, 1, 1}, {36, 1, 2}}};
    const TopologyVote a = persistent_topology(tables, {1, 2}), b = persistent_topology(tables, {0.25, 0.5});
    EXPECT_EQ(a.genus, b.genus);
    EXPECT_DOUBLE_EQ(a.confidence, b.confidence);
}

}  // namespace
}  // namespace neuralmesh
