// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Marching tetrahedra: from a solid on a lattice to a triangle mesh of the same topology.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/shell/lattice.h"

namespace neuralmesh {

/// The surface between the nodes with value < 0 (the solid) and the others, on the Freudenthal subdivision:
/// closed, oriented, simplicial, of exactly the solid's topology, all valences from 4 to 12. Vertices lie on
/// lattice edges, where linear interpolation of the values is 0, but at least a tenth of the edge away from
/// its ends.
/// \pre no value is 0; nodes on the walls of the lattice are positive
/// O(nodes + faces log faces). Source: Doi and Koide 1991. (Marching cubes' tables may join or cut what the
/// lattice counts otherwise.)
IndexedMesh<float> marching_tetrahedra(const Lattice& lattice, const PerNode<float>& values);

/// Whether the tetrahedron between four nodes is to be meshed.
using TetrahedronFilter = std::function<bool(const std::array<NodeId, 4>& nodes)>;

/// The same in the tetrahedra that \p wanted accepts: oriented, simplicial, every edge with one or two faces,
/// but several fans of faces may meet in a vertex. \p nodes receives for every vertex one end of the lattice
/// edge it lies on.
IndexedMesh<float> marching_tetrahedra(const Lattice& lattice, const PerNode<float>& values,
                                       const TetrahedronFilter& wanted, std::vector<NodeId>& nodes);

}  // namespace neuralmesh
