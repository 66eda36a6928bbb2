// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Parallel loops whose results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <vector>

#include "vcg_core/base/thread_team.h"

namespace neuralmesh {

/// Calls \p body(chunk, begin, end) for every chunk of \p size indices of [0, count), on the threads of \p
/// team. The chunks are the same for any number of threads. A call must write only what belongs to its chunk.
/// Where a call or the team's beat throws, no thread takes another chunk; when all have finished theirs, one
/// of the exceptions is rethrown.
template <class Body>
void for_chunks(std::size_t count, std::size_t size, ThreadTeam& team, const Body& body) {
    const std::size_t chunks = (count + size - 1) / size;
    const int members = static_cast<int>(std::min(static_cast<std::size_t>(team.members()), chunks));
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(team.members()));
    std::atomic<std::size_t> next{0};
    team.parallel(members, [&](int member, int) {
        try {
            for (std::size_t c = next++; c < chunks; c = next++) {
                body(c, c * size, std::min(count, (c + 1) * size));
                if (member == 0) team.beat();
            }
        } catch (...) {
            next = chunks;
            errors[static_cast<std::size_t>(member)] = std::current_exception();
        }
    });
    for (const std::exception_ptr& e : errors)
        if (e) std::rethrow_exception(e);
}

/// Calls \p body(i) for every index i of [0, count), on the threads of \p team, \p chunk consecutive indices
/// at a time. A call must write only what belongs to its index. Exceptions as in for_chunks().
template <class Body>
void parallel_for(int count, int chunk, ThreadTeam& team, const Body& body) {
    for_chunks(static_cast<std::size_t>(count), static_cast<std::size_t>(chunk), team,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) body(static_cast<int>(i));
               });
}

/// Calls \p find(i, found) for every index i of [0, count), as parallel_for() does; each call appends what it
/// finds to the vector \p found. \return all that was found, in the order of the indices.
template <class Value, class Find>
std::vector<Value> parallel_collect(int count, int chunk, ThreadTeam& team, const Find& find) {
    const auto chunks = static_cast<std::size_t>((count + chunk - 1) / chunk);
    std::vector<std::vector<Value>> found(chunks);
    for_chunks(static_cast<std::size_t>(count), static_cast<std::size_t>(chunk), team,
               [&](std::size_t c, std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) find(static_cast<int>(i), found[c]);
               });
    std::size_t total = 0;
    for (const std::vector<Value>& part : found) total += part.size();
    std::vector<Value> all;
    all.reserve(total);
    for (const std::vector<Value>& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace neuralmesh
