// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Shared by library_host.cpp and library_host_2020.cpp: the layer to learn, and runs that lack memory.
#pragma once

#include <cmath>

#include "tests/memory/allocations.h"

namespace ball_runs {

using neuralmesh::allocations::Failure;

/// A thousand points distributed evenly over a sphere.
template <class Mesh>
void add_ball(Mesh& mesh) {
    using Scalar = typename Mesh::ScalarType;
    constexpr int kCount = 1000;
    for (int i = 0; i < kCount; ++i) {
        const double z = 1 - (2.0 * i + 1) / kCount, turn = 2.399963229728653 * i, rim = std::sqrt(1 - z * z);
        vcg::tri::Allocator<Mesh>::AddVertex(
            mesh, {Scalar(rim * std::cos(turn)), Scalar(rim * std::sin(turn)), Scalar(z)});
    }
}

inline const char* truth(bool value) { return value ? "true" : "false"; }

/// Calls learn(nth, failure) for every allocation near both ends of \p all, which are the adapter's, and for
/// a sample of those during learning.
template <class Learn>
void starve(long long all, const Learn& learn) {
    for (long long nth = 0; nth < all; nth += nth < 60 || nth > all - 150 ? 1 : (all - 210) / 20 + 1) {
        learn(nth, Failure::once);
        learn(nth, Failure::from_then_on);
    }
}

}  // namespace ball_runs
