// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The mesh of the solid that has the topology voted for.
#pragma once

#include "vcg_core/mesh/network.h"
#include "vcg_core/start/lattice.h"
#include "vcg_core/start/lattice_survey.h"
#include "vcg_core/start/region.h"

namespace neuralmesh {

/// A closed mesh, and the solid on the region's lattice that it bounds.
struct ClosedMesh {
    Network network;
    NodeSet solid;
    int level = 0;  ///< of the solid
};

/// A mesh of the grown solid of \p vote, from the lattice of \p region. It is made on every third or second
/// node if that keeps the topology, because fewer faces take less time to reduce; otherwise on all nodes,
/// where it has exactly the topology counted. The network is empty if the solid is. O(nodes + faces log
/// faces).
ClosedMesh closed_mesh(const Region& region, const TopologyVote& vote);

}  // namespace neuralmesh
