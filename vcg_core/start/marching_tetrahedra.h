// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Marching tetrahedra: from a solid on a lattice to a triangle mesh of the same topology.
#pragma once

#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// The surface between the nodes with value < 0 (the solid) and the others, on the Freudenthal subdivision:
/// closed, oriented, simplicial, of exactly the solid's topology, all valences from 4 to 12. Vertices lie on
/// lattice edges, where linear interpolation of the values is 0, but at least a tenth of the edge away from
/// its ends.
/// \pre no value is 0; nodes on the walls of the lattice are positive
/// O(nodes + faces log faces). Source: Doi and Koide 1991. (Marching cubes' tables may join or cut what the
/// lattice counts otherwise.)
IndexedMesh<float> marching_tetrahedra(const Lattice& lattice, const PerNode<float>& values);

}  // namespace neuralmesh
