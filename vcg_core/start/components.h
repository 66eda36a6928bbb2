// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The topology of a set of lattice nodes, from runs and words of nodes instead of one by one.
#pragma once

#include <functional>

#include "vcg_core/base/indexed.h"
#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// Consecutive nodes of a row along x.
struct Run {
    NodeId begin, end;

    /// Their range of \p values.
    template <class T>
    auto begin_in(T& values) const {
        return values.begin() + begin;
    }
    template <class T>
    auto end_in(T& values) const {
        return values.begin() + end;
    }
};

/// Calls visit(runs) for each connected component of the nodes i with nodes[i] = \p value, 0 or 1, in order
/// of their smallest nodes; the runs are in ascending order. \p visit may change \p nodes. O(nodes), a
/// hundred at a time, + O(runs).
void for_each_component(const Lattice& lattice, const NodeSet& nodes, std::uint8_t value,
                        const std::function<void(Span<const Run>)>& visit);

/// Euler characteristic of the simplices all of whose nodes are in \p solid: components - handles + cavities.
/// O(nodes), 64 at a time.
int euler_characteristic(const Lattice& lattice, const NodeSet& solid);

}  // namespace neuralmesh
