// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Threads that share chunks, and loops over all cores that give what the plain loop gives.
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "tests/unit/support/prelude.h"
#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"

namespace neuralmesh::threads_test {

TEST(ThreadTeam, DoesEveryChunkOnce) {
    for (const int members : {1, 2, 5}) {
        ThreadTeam team(members);
        ASSERT_EQ(team.members(), members);
        for (int round = 0; round < 3000; ++round) {
            const int chunks = round % 40;
            std::vector<int> done(40, 0);
            std::vector<int> inside(static_cast<std::size_t>(members), 0);
            bool alone = true;
            team.parallel(chunks, [&](int member, int chunk) {
                int& here = inside[static_cast<std::size_t>(member)];
                if (++here != 1) alone = false;
                ++done[static_cast<std::size_t>(chunk)];
                --here;
            });
            ASSERT_TRUE(alone);
            for (int c = 0; c < 40; ++c) ASSERT_EQ(done[static_cast<std::size_t>(c)], c < chunks ? 1 : 0);
        }
    }
}

TEST(ThreadTeam, WakesSleepingHelpers) {
    ThreadTeam team(3);
    for (int round = 0; round < 20; ++round) {
        std::vector<int> done(ThreadTeam::kMost, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        team.parallel(ThreadTeam::kMost, [&](int, int chunk) { ++done[static_cast<std::size_t>(chunk)]; });
        for (const int count : done) ASSERT_EQ(count, 1);
    }
}

TEST(ThreadTeam, HelpersTakePart) {
    ThreadTeam team(2);
    // The caller's chunk ends when the helper's has begun.
    std::atomic<bool> helped{false};
    team.parallel(2, [&](int member, int) {
        if (member == 1) {
            helped = true;
        } else {
            while (!helped) std::this_thread::yield();
        }
    });
    EXPECT_TRUE(helped);
}

/// The caller waits in its first chunk until a helper is awake, so that all reach for the others at a time.
TEST(ThreadTeam, NoTwoMembersTakeOneChunk) {
    ThreadTeam team(4);
    for (int round = 0; round < 3000; ++round) {
        std::array<std::atomic<int>, ThreadTeam::kMost> done{};
        std::atomic<bool> helped{false};
        team.parallel(ThreadTeam::kMost, [&](int member, int chunk) {
            ++done[static_cast<std::size_t>(chunk)];
            if (member != 0) helped = true;
            while (!helped) std::this_thread::yield();
        });
        for (const std::atomic<int>& times : done) ASSERT_EQ(times.load(), 1);
    }
}

// Loops over all cores give what the plain loop gives.

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

}  // namespace neuralmesh::threads_test
