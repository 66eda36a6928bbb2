// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Loops over all cores give what the plain loop gives.
#include "vcg_core/base/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "vcg_core/base/median.h"

namespace neuralmesh {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
    for (int threads : {1, 3})
        for (int count : {0, 1, 7, 100}) {
            ThreadTeam team(threads);
            std::vector<int> visits(static_cast<std::size_t>(count), 0);
            parallel_for(count, 7, team, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
            EXPECT_EQ(visits, std::vector<int>(static_cast<std::size_t>(count), 1));
        }
}

TEST(ParallelFor, RethrowsWhatACallThrows) {
    ThreadTeam team(2);
    EXPECT_THROW(parallel_for(100, 1, team,
                              [](int i) {
                                  if (i == 60) throw std::runtime_error("60");
                              }),
                 std::runtime_error);
}

TEST(ParallelFor, CallsTheBeatOfTheTeamAndEndsWithWhatItThrows) {
    for (const int threads : {1, 3}) {
        ThreadTeam team(threads);
        int beats = 0;
        team.set_beat([&] { ++beats; });
        parallel_for(100, 1, team, [](int) {});
        EXPECT_GE(beats, 1);  // at once, and then not before a tenth of a second has passed
        EXPECT_LT(beats, 100);
        ThreadTeam stopped(threads);
        stopped.set_beat([] { throw std::runtime_error("stop"); });
        std::atomic<int> calls{0};
        EXPECT_THROW(parallel_for(1000000, 1, stopped, [&](int) { ++calls; }), std::runtime_error);
        EXPECT_LT(calls, 1000000);
    }
}

TEST(ParallelCollect, KeepsTheOrderOfTheIndices) {
    std::vector<int> expected;
    for (int i = 0; i < 1000; ++i)
        for (int k = 0; k < i % 3; ++k) expected.push_back(i);
    for (int threads : {1, 2, 5}) {
        ThreadTeam team(threads);
        EXPECT_EQ(parallel_collect<int>(1000, 64, team,
                                        [](int i, std::vector<int>& found) {
                                            for (int k = 0; k < i % 3; ++k) found.push_back(i);
                                        }),
                  expected);
    }
}

}  // namespace
}  // namespace neuralmesh
