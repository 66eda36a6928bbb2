// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A surface with boundary through oriented tangent planes: the zero set of the signed distance to them, taken
// where there are planes and nowhere else.
#pragma once

#include <vector>

#include "vcg_core/shell/marching_tetrahedra.h"
#include "vcg_core/shell/tangent_planes.h"

namespace neuralmesh {

/// An oriented 2-manifold with boundary, as an indexed mesh, and for every vertex the plane it lies on.
struct Contour {
    IndexedMesh<float> mesh;
    std::vector<int> plane;
};

/// Contours the signed distance (a blend of that to the planes nearby with like normals) on a lattice of
/// \p planes.step. The surface ends about a spacing from the centre of the last plane, and where neighbouring
/// planes contradict each other. Vertices where the pieces of surface around meet only in the vertex are
/// doubled. O(nodes + planes (widest spacing / step)^3).
Contour one_layer_contour(const vcg::Box3f& box, const TangentPlanes& planes);

}  // namespace neuralmesh
