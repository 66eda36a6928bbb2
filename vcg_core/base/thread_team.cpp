// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Claims by the bits of one atomic word; spinning, then sleeping.
#include "vcg_core/base/thread_team.h"

#include <algorithm>
#include <exception>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

namespace {

/// Turns of the waiting loop before a helper goes to sleep: some 200 microseconds, longer than what the
/// caller does between two loops.
constexpr int kSpins = 16000;

}  // namespace

ThreadTeam::ThreadTeam(int members) {
    const int most = std::min(members, kMost);
    helpers_.reserve(static_cast<std::size_t>(std::max(most - 1, 0)));
    for (int i = 1; i < most; ++i) {
        try {
            helpers_.emplace_back(&ThreadTeam::help, this, i);
        } catch (const std::exception&) {
            break;  // no memory or no thread left for one more: fewer do the same work
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

void ThreadTeam::start(Call call, const void* body, int chunks) {
    // The caller's own chunk is not up for claims, which would pass the word to and fro between the cores.
    offer(call, body, (bit(chunks - 1) - 1) << 1);
    call(body, 0, 0);
    finish();
}

/// Puts the chunks whose bits are set up for claims.
void ThreadTeam::offer(Call call, const void* body, std::uint64_t chunks) {
    call_ = call;
    body_ = body;
    open_.store(bit_count(chunks), std::memory_order_relaxed);
    unclaimed_.store(chunks);
    if (asleep_.load() > 0) {
        const std::lock_guard<std::mutex> lock(mutex_);
        wake_.notify_all();
    }
}

/// Does what nobody has claimed, and waits for the rest.
void ThreadTeam::finish() {
    work(0);
    for (int turn = 0; open_.load(std::memory_order_acquire) > 0; ++turn) {
        if (turn < kSpins) {
            spin_pause();
        } else {
            std::this_thread::yield();
        }
    }
}

/// Does chunks until there is none left, its own first. \return whether there was one.
bool ThreadTeam::work(int member) {
    bool worked = false;
    for (;;) {
        const std::uint64_t seen = unclaimed_.load(std::memory_order_relaxed);
        if (seen == 0) return worked;
        const std::uint64_t wanted = (seen & bit(member)) != 0 ? bit(member) : seen & -seen;
        // Whoever comes late may claim of the next round: what is called is read after the claim.
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
