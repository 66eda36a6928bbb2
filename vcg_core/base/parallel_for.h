// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A loop over all cores whose results do not depend on how many there are.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <vector>

#include "vcg_core/base/thread_team.h"

namespace neuralmesh {

/// Calls \p body(chunk, begin, end) for every chunk of \p size indices of [0, count), by \p team. The chunks
/// are the same for any number of threads; a body writes only what belongs to its chunk. A member of the team
/// whose body throws takes no more chunks, the others go on; then one of the exceptions is thrown on.
template <class Body>
void for_chunks(std::size_t count, std::size_t size, ThreadTeam& team, const Body& body) {
    const std::size_t chunks = (count + size - 1) / size;
    const int members = static_cast<int>(std::min(static_cast<std::size_t>(team.members()), chunks));
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(team.members()));
    std::atomic<std::size_t> next{0};
    team.parallel(members, [&](int member, int) {
        try {
            for (std::size_t c = next++; c < chunks; c = next++)
                body(c, c * size, std::min(count, (c + 1) * size));
        } catch (...) {
            errors[static_cast<std::size_t>(member)] = std::current_exception();
        }
    });
    for (const std::exception_ptr& e : errors)
        if (e) std::rethrow_exception(e);
}

}  // namespace neuralmesh
