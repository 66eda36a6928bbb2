// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moves of a solution that take the surface away from the points.
#pragma once

#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// Halves, and in the end undoes, the moves of the vertices around which the surface has come away from its
/// points: where the squared distances of the points on the faces around the vertex, up to 12 of each, have
/// risen by more than by chance. The least squares keep each point with its face and measure to the planes of
/// faces, so where the surface bends, at creases above all, their solution can be farther from the points
/// than the surface before.
///
/// \param before the surface of \p network before the moves, to which \p points are assigned with their feet
/// \param moved the same faces after the moves; changed in place
///
/// O(vertices).
void shorten_harmful_moves(const Network& network, const Surface& before, Surface& moved,
                           const PointsByFace& points, ThreadTeam& team);

}  // namespace neuralmesh
