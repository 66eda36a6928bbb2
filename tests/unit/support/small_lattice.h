// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A lattice small enough for brute force, and random points on it.
#pragma once

#include "tests/unit/support/prelude.h"
#include "vcg_core/base/random.h"
#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// 12 x 14 x 11 nodes.
inline Lattice small_lattice() {
    return Lattice(vcg::Box3f(vcg::Point3f(0, 0, 0), vcg::Point3f(9, 11, 8)), 1.0F, 1);
}

/// 1 to 3 points at one node in \p one_in, on average.
inline PerNode<std::uint32_t> random_counts(const Lattice& lattice, std::uint64_t seed,
                                            std::uint32_t one_in) {
    Random random(seed);
    PerNode<std::uint32_t> counts(lattice.size(), 0);
    for (std::uint32_t& c : counts)
        if (random.below(one_in) == 0) c = 1 + random.below(3);
    return counts;
}

}  // namespace neuralmesh
