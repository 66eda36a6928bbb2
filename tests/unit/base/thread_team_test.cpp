// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/thread_team.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace neuralmesh {
namespace {

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

}  // namespace
}  // namespace neuralmesh
