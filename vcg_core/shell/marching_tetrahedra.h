// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// From a solid on a lattice to a triangle mesh of the same topology.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/mesh/network.h"
#include "vcg_core/shell/level_topology.h"

namespace neuralmesh {

/// A surface as an indexed mesh, counter-clockwise seen from outside.
struct IndexedMesh {
    std::vector<vcg::Point3f> positions;
    std::vector<Triangle> faces;
};

/// The surface between the nodes with value < 0 (the solid) and the others, on the Freudenthal subdivision:
/// closed, oriented, simplicial, of exactly the solid's topology, all valences from 4 to 12. Values are
/// interpolated along the edges; none may be 0, and nodes on the walls of the box must be positive.
/// O(nodes + faces log faces). (Marching tetrahedra: Doi and Koide 1991. Marching cubes' tables may join or
/// cut what the lattice counts otherwise.)
IndexedMesh marching_tetrahedra(const Lattice& lattice, const std::vector<float>& values);

}  // namespace neuralmesh
