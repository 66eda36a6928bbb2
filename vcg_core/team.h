// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Threads that stay, for loops of a few microseconds: starting a thread would take longer than its work.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace neuralmesh {

/// The caller's thread and helpers beside it. A helper waits for work by spinning for some microseconds, then
/// asleep. A helper that is late, because the machine has other things to do, is not waited for: whoever is
/// there does the chunks.
class Team {
public:
    /// \p members threads in all, at least 1. Where the system gives no thread, the team is smaller.
    explicit Team(int members);
    ~Team();

    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;

    int members() const { return 1 + static_cast<int>(helpers_.size()); }

    /// Calls \p body(member, chunk) for every chunk of [0, \p chunks), each once, and returns when all are
    /// done. member < members(), and no two calls of one member overlap. A body must not throw and writes
    /// only what belongs to its chunk or its member. \p chunks < 65,536. About a microsecond beyond the work.
    template <class Body>
    void run(int chunks, const Body& body) {
        if (members() == 1 || chunks <= 1) {
            for (int c = 0; c < chunks; ++c) body(0, c);
            return;
        }
        start([](const void* b, int member, int chunk) { (*static_cast<const Body*>(b))(member, chunk); },
              &body, chunks);
    }

private:
    using Call = void (*)(const void* body, int member, int chunk);

    void start(Call call, const void* body, int chunks);
    bool work(int member);
    void help(int member);

    // One word, so that a claim is of the round it is made in: round << 32 | chunks << 16 | next chunk.
    std::atomic<std::uint64_t> ticket_{0};
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
