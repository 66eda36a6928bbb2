// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A thread pool for parallel loops of a few microseconds.
//
// An OpenMP loop waits for all of its threads: two chunks of 2 us took .6 us more than the work on free
// cores, and .5 ms on average on cores shared with other processes; here .2 us and .01 ms (GCC 12, two
// cores). TBB would be one more library to install in every host.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace neuralmesh {

/// \p threads if positive, else the number of cores.
inline int thread_count(int threads) {
    return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// The calling thread (member 0) and its helpers. An idle helper spins for about 200 microseconds, then
/// sleeps. A loop does not wait for helpers that the system has not scheduled: members that run take over
/// their chunks. If all members run, member i executes chunk i, so the data of a chunk stays in the cache of
/// one core.
class ThreadTeam {
public:
    /// Upper limit of members, and of chunks of one loop.
    static constexpr int kMost = 64;

    /// A team of \p members threads, at least 1 and at most kMost; of fewer if the system has no more
    /// threads.
    explicit ThreadTeam(int members);
    ~ThreadTeam();

    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;

    int members() const { return 1 + static_cast<int>(helpers_.size()); }

    /// From now on \p beat is called between the chunks of the loops of parallel_for.h, on the caller's
    /// thread and not before a tenth of a second has passed since its last call. It may throw, which ends the
    /// loop.
    void set_beat(std::function<void()> beat) { beat_ = std::move(beat); }
    /// Calls it, if it is due.
    void beat();

    /// Calls \p body(member, chunk) once for every chunk of [0, \p chunks), chunks <= kMost, and returns when
    /// all calls have returned. Calls of the same member never overlap; 0 <= member < members(). A body must
    /// not throw and may write only data of its chunk or of its member. Overhead: below a microsecond.
    template <class Body>
    void parallel(int chunks, const Body& body) {
        if (members() == 1 || chunks <= 1) {
            for (int c = 0; c < chunks; ++c) body(0, c);
            return;
        }
        start([](const void* b, int member, int chunk) { (*static_cast<const Body*>(b))(member, chunk); },
              &body, chunks);
    }

private:
    using Call = void (*)(const void* body, int member, int chunk);

    static constexpr std::uint64_t bit(int i) { return std::uint64_t{1} << i; }

    void start(Call call, const void* body, int chunks);
    bool work(int member);
    void help(int member);

    /// Bit i is set while no member has claimed chunk i. Starts a cache line, together with the members that
    /// are read along with it.
    alignas(64) std::atomic<std::uint64_t> unclaimed_{0};
    std::atomic<int> open_{0};  ///< chunks of the current loop that are not finished
    Call call_ = nullptr;
    const void* body_ = nullptr;
    std::atomic<bool> over_{false};
    std::atomic<int> asleep_{0};
    std::mutex mutex_;
    std::condition_variable wake_;
    std::vector<std::thread> helpers_;
    std::function<void()> beat_;
    std::chrono::steady_clock::time_point last_beat_{};
};

}  // namespace neuralmesh
