// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Control over all allocations of this program's own code: operator new, and the malloc that Eigen calls.
#pragma once

#pragma GCC visibility push(default)  // a program lends them to the libraries it loads

namespace neuralmesh::allocations {

/// How a machine runs out of memory.
enum class Failure {
    once,         ///< one large request fails, later ones succeed
    from_then_on  ///< nothing is left any more
};

/// From now on, over all threads, the \p nth allocation fails (counted from 0; -1: none does). Resets
/// count().
void fail_at(long long nth, Failure failure = Failure::once);
/// Allocations since the last call of fail_at().
long long count();
/// Blocks allocated and not given back since the program started.
long long living();

}  // namespace neuralmesh::allocations

#pragma GCC visibility pop
