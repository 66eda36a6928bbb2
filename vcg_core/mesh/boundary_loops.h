// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Boundary loops of an indexed mesh: found, measured and filled.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/mesh/ring.h"

namespace neuralmesh {

/// The boundary loops of an oriented manifold of \p vertices vertices, each a list of vertices such that the
/// surface lies to the left of every step. O(faces).
std::vector<std::vector<VertexId>> boundary_loops(int vertices, const std::vector<Triangle>& faces);

/// Diameter of the smallest sphere around \p points, to about 1 % (Badoiu and Clarkson, "Smaller Core-Sets
/// for Balls", 2003). O(points).
float smallest_sphere_diameter(const std::vector<vcg::Point3f>& points);

/// Fills the hole that \p loop bounds by cutting ears, those of the smallest angle first, and adds the faces
/// to \p faces; no vertex gets more than \p most_neighbours of them, \p neighbours[v] being how many v has.
/// No edge comes to be there twice. \return false, with \p faces and \p neighbours unchanged, if that cannot
/// be. O(n^2).
bool fill_hole(const std::vector<VertexId>& loop, const std::vector<vcg::Point3f>& positions,
               int most_neighbours, std::vector<int>& neighbours, std::vector<Triangle>& faces);

}  // namespace neuralmesh
