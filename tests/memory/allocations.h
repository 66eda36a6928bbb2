// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Counts allocations of this program's own code, and makes them fail: operator new, and the malloc of Eigen.
#pragma once

#pragma GCC visibility push(default)  // libraries that a program loads use its functions

namespace neuralmesh::allocations {

/// How a machine runs out of memory.
enum class Failure {
    once,         ///< one large request fails, later ones succeed
    from_then_on  ///< that request and all later ones fail
};

/// Makes the \p nth allocation from now on fail, counted from 0 over all threads; -1: none. Resets count().
void fail_at(long long nth, Failure failure = Failure::once);
/// Allocations since the last call of fail_at().
long long count();
/// Blocks allocated since the start of the program and not yet freed.
long long living();
/// Resident memory of this process.
long long resident_bytes();

}  // namespace neuralmesh::allocations

#pragma GCC visibility pop
