// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// From a solid on a lattice to a triangle mesh of the same topology.
#pragma once

#include <cmath>

#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/start/lattice_survey.h"

namespace neuralmesh {

/// The surface between the nodes with value < 0 (the solid) and the others, on the Freudenthal subdivision:
/// closed, oriented, simplicial, of exactly the solid's topology, all valences from 4 to 12. Vertices lie on
/// lattice edges, where linear interpolation of the values is 0, but at least a tenth of the edge away from
/// its ends.
/// \pre no value is 0; nodes on the walls of the lattice are positive
/// O(nodes + faces log faces). Source: Doi and Koide 1991. (Marching cubes' tables may join or cut what the
/// lattice counts otherwise.)
IndexedMesh<float> marching_tetrahedra(const Lattice& lattice, const PerNode<float>& values);

/// A closed mesh, and the solid on the region's lattice that it bounds.
struct ClosedMesh {
    Network network;
    NodeSet solid;
    int level = 0;  ///< of the solid

    /// In lattice steps: that of the balls whose solid ends between this level and the next.
    float radius() const { return std::sqrt(static_cast<float>(level) + 0.5F); }
};

/// A mesh of the grown solid of \p vote, from the lattice of \p region. It is made on every third or second
/// node if that keeps the topology, because fewer faces take less time to reduce; otherwise on all nodes,
/// where it has exactly the topology counted. The network is empty if the solid is. O(nodes + faces log
/// faces).
ClosedMesh closed_mesh(const Region& region, const TopologyVote& vote);

}  // namespace neuralmesh
