// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The neighbours of a lattice node that have a property, and the topology of what lies between them.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// The neighbours with smaller ids than the node: every second one.
inline constexpr NeighbourSet kSmallerIds = 0b10101010101010U;

/// The neighbours of node \p i at the places \p places (Neighbours::places()) that are members: member(j).
template <class Member>
NeighbourSet neighbours_in(const Neighbours& neighbours, NodeId i, NeighbourSet places,
                           const Member& member) {
    NeighbourSet set = 0;
    neighbours.for_each_at(i, places, [&](NodeId j, int k) { set |= NeighbourSet{member(j)} << k; });
    return set;
}

/// The topology of every set of neighbours. The neighbours of a node are the vertices of a triangulated
/// sphere, the node's link; a set stands for the part of the sphere between its vertices.
class LinkTopology {
public:
    /// Made once, and shared by all threads.
    static const LinkTopology& table();

    /// The empty set is not.
    bool is_connected(NeighbourSet set) const { return connected_[set] != 0; }
    /// Vertices - edges + triangles.
    int euler_characteristic(NeighbourSet set) const { return euler_[set]; }

private:
    LinkTopology();

    std::vector<std::uint8_t> connected_;
    std::vector<std::int8_t> euler_;
};

/// Euler characteristic of the simplices all of whose nodes are in \p solid: components - handles + cavities.
/// Each node adds 1 - that of its neighbours with smaller ids in the solid (Banchoff 1967). O(nodes).
int euler_characteristic(const Lattice& lattice, const NodeSet& solid);

}  // namespace neuralmesh
