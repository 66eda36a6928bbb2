// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Claims by one atomic word; spinning, then sleeping.
#include "team.h"

#include <system_error>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace neuralmesh {

namespace {

/// Turns of the waiting loop before a helper goes to sleep: some 200 microseconds, longer than what the
/// caller does between two loops.
constexpr int kSpins = 16000;

void relax() {
#ifdef __SSE2__
    _mm_pause();
#endif
}

constexpr std::uint64_t kChunkMask = 0xffff;
int next_of(std::uint64_t ticket) { return static_cast<int>(ticket & kChunkMask); }
int chunks_of(std::uint64_t ticket) { return static_cast<int>(ticket >> 16 & kChunkMask); }
std::uint64_t round_of(std::uint64_t ticket) { return ticket >> 32; }

}  // namespace

Team::Team(int members) {
    for (int i = 1; i < members; ++i) {
        try {
            helpers_.emplace_back(&Team::help, this, i);
        } catch (const std::system_error&) {
            break;  // fewer do the same work
        }
    }
}

Team::~Team() {
    over_.store(true);
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        wake_.notify_all();
    }
    for (std::thread& t : helpers_) t.join();
}

void Team::start(Call call, const void* body, int chunks) {
    call_ = call;
    body_ = body;
    open_.store(chunks, std::memory_order_relaxed);
    const std::uint64_t round = round_of(ticket_.load(std::memory_order_relaxed)) + 1;
    ticket_.store(round << 32 | static_cast<std::uint64_t>(chunks) << 16);
    if (asleep_.load() > 0) {
        const std::lock_guard<std::mutex> lock(mutex_);
        wake_.notify_all();
    }
    work(0);
    for (int turn = 0; open_.load(std::memory_order_acquire) > 0; ++turn) {
        if (turn < kSpins) {
            relax();
        } else {
            std::this_thread::yield();
        }
    }
}

/// Does chunks until there is none left. \return whether there was one.
bool Team::work(int member) {
    bool worked = false;
    for (;;) {
        const std::uint64_t seen = ticket_.load(std::memory_order_relaxed);
        // Looked at first, so that the counter of claims in vain cannot run over.
        if (next_of(seen) >= chunks_of(seen)) return worked;
        const std::uint64_t claim = ticket_.fetch_add(1, std::memory_order_acq_rel);
        if (next_of(claim) >= chunks_of(claim)) return worked;
        call_(body_, member, next_of(claim));
        open_.fetch_sub(1, std::memory_order_release);
        worked = true;
    }
}

void Team::help(int member) {
    int turns = 0;
    while (!over_.load(std::memory_order_relaxed)) {
        if (work(member)) {
            turns = 0;
            continue;
        }
        if (++turns < kSpins) {
            relax();
            continue;
        }
        std::unique_lock<std::mutex> lock(mutex_);
        asleep_.fetch_add(1);
        wake_.wait(lock, [this] {
            const std::uint64_t ticket = ticket_.load();
            return over_.load() || next_of(ticket) < chunks_of(ticket);
        });
        asleep_.fetch_sub(1);
        turns = 0;
    }
}

}  // namespace neuralmesh
