// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A loop over all cores whose results do not depend on how many there are.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

#include "team.h"

namespace neuralmesh {

/// Calls \p body(chunk, begin, end) for every chunk of \p size indices of [0, count), on up to \p threads
/// threads. The chunks are the same for any number of threads; a body writes only what belongs to its chunk.
/// The first exception of a body is thrown on.
template <class Body>
void for_chunks(std::size_t count, std::size_t size, int threads, const Body& body) {
    const std::size_t chunks = (count + size - 1) / size;
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t c = next++; c < chunks; c = next++)
            body(c, c * size, std::min(count, (c + 1) * size));
    };
    const std::size_t helpers = std::min(static_cast<std::size_t>(thread_count(threads)), chunks);
    if (helpers <= 1) {
        work();
        return;
    }
    std::vector<std::exception_ptr> errors(helpers);
    const auto guarded = [&](std::size_t i) {
        try {
            work();
        } catch (...) {
            errors[i] = std::current_exception();
        }
    };
    std::vector<std::thread> pool;
    pool.reserve(helpers - 1);
    try {
        for (std::size_t i = 1; i < helpers; ++i) pool.emplace_back(guarded, i);
    } catch (const std::exception&) {
        // The system has no memory or no thread left for one more: those there are do all the work.
    }
    guarded(0);
    for (std::thread& t : pool) t.join();
    for (const std::exception_ptr& e : errors)
        if (e) std::rethrow_exception(e);
}

}  // namespace neuralmesh
