// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A surface with boundary through evenly spaced points with normals.
//
// Around each point, its neighbours in the tangent plane have a planar Delaunay triangulation; the triangles
// at the point are its star (Gopi, Krishnan, Silva, "Surface reconstruction based on lower dimensional
// localized Delaunay triangulation", 2000). A triangle in the stars of its three corners is surely one of the
// surface. The others follow, smallest first, where they leave the surface an oriented manifold.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/indexed_mesh.h"

namespace neuralmesh {

/// Neighbours farther than so many radii are not looked at: a star reaches no further.
constexpr float kStarReach = 3;

/// Triangulates \p positions with \p normals, which point to one side of the surface. No two points should be
/// closer than about their \p radii, and none of the surface farther than that from the next; gaps that are
/// wider stay open. A vertex where pieces of surface meet in that vertex only is doubled: \p source gives the
/// point of each vertex. Points without a face are left out. O(points log points).
IndexedMesh<float> triangulation(const std::vector<vcg::Point3f>& positions,
                                 const std::vector<vcg::Point3f>& normals, const std::vector<float>& radii,
                                 ThreadTeam& team, std::vector<int>& source);

}  // namespace neuralmesh
