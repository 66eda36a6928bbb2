// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The neighbours of a lattice node that have a property, and whether they are connected with each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vcg_core/shell/lattice.h"

namespace neuralmesh {

/// Some of the 14 neighbours of a node, as bits in the order of kNeighbourOffsets.
using NeighbourSet = std::uint32_t;

/// The neighbours j of node \p i with member(j).
template <class Member>
NeighbourSet neighbours_in(const Neighbours& neighbours, NodeId i, const Member& member) {
    NeighbourSet set = 0;
    neighbours.for_each(i, [&](NodeId j, int k) { set |= NeighbourSet{member(j)} << k; });
    return set;
}

/// For every set of neighbours, whether it is connected; the empty one is not. The neighbours of a node are
/// the vertices of a triangulated sphere, the node's link.
class LinkConnected {
public:
    /// Made once, and shared by all threads.
    static const LinkConnected& table();

    bool operator()(NeighbourSet set) const { return connected_[set] != 0; }

private:
    LinkConnected();

    std::vector<std::uint8_t> connected_;
};

}  // namespace neuralmesh
