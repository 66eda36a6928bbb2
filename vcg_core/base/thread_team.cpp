// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Members claim chunks by clearing bits of one atomic word.
#include "vcg_core/base/thread_team.h"

#include <algorithm>
#include <exception>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

namespace {

/// Turns of the waiting loop before a helper sleeps: about 200 microseconds, longer than the serial part
/// between two loops of the learning.
constexpr int kSpins = 16000;

}  // namespace

ThreadTeam::ThreadTeam(int members) {
    const int most = std::min(members, kMost);
    helpers_.reserve(static_cast<std::size_t>(std::max(most - 1, 0)));
    for (int i = 1; i < most; ++i) {
        try {
            helpers_.emplace_back(&ThreadTeam::help, this, i);
        } catch (const std::exception&) {
            break;  // no thread or no memory for one: continue with a smaller team
        }
    }
}

ThreadTeam::~ThreadTeam() {
    over_.store(true);
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        wake_.notify_all();
    }
    for (std::thread& t : helpers_) t.join();
}

void ThreadTeam::beat() {
    constexpr std::chrono::milliseconds kPause(100);
    if (!beat_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_beat_ < kPause) return;
    last_beat_ = now;
    beat_();
}

/// Lets the helpers claim all chunks but 0, executes that and those that no helper has claimed, and waits for
/// the others.
void ThreadTeam::start(Call call, const void* body, int chunks) {
    call_ = call;
    body_ = body;
    open_.store(chunks - 1, std::memory_order_relaxed);
    // Chunk 0 is not offered: claiming it would move the word's cache line to the caller and back.
    unclaimed_.store((bit(chunks - 1) - 1) << 1);
    if (asleep_.load() > 0) {
        const std::lock_guard<std::mutex> lock(mutex_);
        wake_.notify_all();
    }
    call(body, 0, 0);
    work(0);
    for (int turn = 0; open_.load(std::memory_order_acquire) > 0; ++turn) {
        if (turn < kSpins) {
            spin_pause();
        } else {
            std::this_thread::yield();
        }
    }
}

/// Claims and executes chunks, first the one of its own number, until none is left. \return false if it got
/// none
bool ThreadTeam::work(int member) {
    bool worked = false;
    for (;;) {
        const std::uint64_t seen = unclaimed_.load(std::memory_order_relaxed);
        if (seen == 0) return worked;
        const std::uint64_t wanted = (seen & bit(member)) != 0 ? bit(member) : seen & -seen;
        // call_ and body_ are read after the claim, which may already be one of the next loop.
        if ((unclaimed_.fetch_and(~wanted, std::memory_order_acq_rel) & wanted) == 0) continue;
        call_(body_, member, lowest_bit(wanted));
        open_.fetch_sub(1, std::memory_order_release);
        worked = true;
    }
}

void ThreadTeam::help(int member) {
    int turns = 0;
    while (!over_.load(std::memory_order_relaxed)) {
        if (work(member)) {
            turns = 0;
            continue;
        }
        if (++turns < kSpins) {
            spin_pause();
            continue;
        }
        std::unique_lock<std::mutex> lock(mutex_);
        asleep_.fetch_add(1);
        wake_.wait(lock, [this] { return over_.load() || unclaimed_.load() != 0; });
        asleep_.fetch_sub(1);
        turns = 0;
    }
}

}  // namespace neuralmesh
