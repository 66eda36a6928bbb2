// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Threads that stay, for loops of a few microseconds: starting a thread would take longer than its work.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace neuralmesh {

/// \p threads, or the number of the machine's cores if it is not positive.
inline int thread_count(int threads) {
    return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// The caller's thread and helpers beside it. A helper waits for work by spinning for some microseconds, then
/// asleep. A helper that is late, because the machine has other things to do, is not waited for: whoever is
/// there does the chunks. Where all are there, member i does chunk i, so that what belongs to a chunk stays
/// in one core's cache from one loop to the next.
class ThreadTeam {
public:
    /// Chunks of one loop, and members, at most.
    static constexpr int kMost = 64;

    /// \p members threads in all, at least 1. Where the system gives no thread, the team is smaller.
    explicit ThreadTeam(int members);
    ~ThreadTeam();

    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;

    int members() const { return 1 + static_cast<int>(helpers_.size()); }

    /// Calls \p body(member, chunk) for every chunk of [0, \p chunks), each once, and returns when all are
    /// done. member < members(), and no two calls of one member overlap. A body must not throw and writes
    /// only what belongs to its chunk or its member. \p chunks <= kMost. About a microsecond beyond the work.
    template <class Body>
    void parallel(int chunks, const Body& body) {
        if (members() == 1 || chunks <= 1) {
            for (int c = 0; c < chunks; ++c) body(0, c);
            return;
        }
        start([](const void* b, int member, int chunk) { (*static_cast<const Body*>(b))(member, chunk); },
              &body, chunks);
    }

    /// While it lives a helper does what run_in_background() was given.
    class [[nodiscard]] BackgroundTask {
    public:
        BackgroundTask() = default;  ///< nothing is being done
        explicit BackgroundTask(ThreadTeam& team) : team_(&team) {}
        ~BackgroundTask() {
            if (team_ != nullptr) team_->finish();
        }
        BackgroundTask(const BackgroundTask&) = delete;
        BackgroundTask& operator=(const BackgroundTask&) = delete;

    private:
        ThreadTeam* team_ = nullptr;
    };

    /// Calls \p body() once, in a helper while the caller goes on, and at the latest when the result is
    /// destroyed. Until then parallel() and run_in_background() must not be called, nor anything be touched
    /// that \p body touches. It must not throw, and must live as long as the result.
    template <class Body>
    BackgroundTask run_in_background(const Body& body) {
        offer([](const void* b, int, int) { (*static_cast<const Body*>(b))(); }, &body, bit(1));
        return BackgroundTask(*this);
    }

private:
    using Call = void (*)(const void* body, int member, int chunk);

    static constexpr std::uint64_t bit(int i) { return std::uint64_t{1} << i; }

    void start(Call call, const void* body, int chunks);
    void offer(Call call, const void* body, std::uint64_t chunks);
    void finish();
    bool work(int member);
    void help(int member);

    /// Bit i: chunk i of this round is nobody's yet. In a line of its own with what else is asked for at
    /// once.
    alignas(64) std::atomic<std::uint64_t> unclaimed_{0};
    std::atomic<int> open_{0};  ///< chunks of this round that are not done
    Call call_ = nullptr;
    const void* body_ = nullptr;
    std::atomic<bool> over_{false};
    std::atomic<int> asleep_{0};
    std::mutex mutex_;
    std::condition_variable wake_;
    std::vector<std::thread> helpers_;
};

}  // namespace neuralmesh
