// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The neighbours of a lattice node that have a property, and the topology of what lies between them.
#pragma once

#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// The neighbours of node \p i at the places \p places (Neighbours::places()) that are members: member(j).
template <class Member>
NeighbourSet neighbours_in(const Neighbours& neighbours, NodeId i, NeighbourSet places,
                           const Member& member) {
    NeighbourSet set = 0;
    neighbours.for_each_at(i, places, [&](NodeId j, int k) { set |= NeighbourSet{member(j)} << k; });
    return set;
}

/// Whether a set of neighbours is connected. The empty set is not.
bool is_connected(NeighbourSet set);

/// Euler characteristic of the simplices all of whose nodes are in \p solid: components - handles + cavities.
/// O(nodes), 64 at a time.
int euler_characteristic(const Lattice& lattice, const NodeSet& solid);

}  // namespace neuralmesh
