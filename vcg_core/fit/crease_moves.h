// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moves vertices beside a crease onto it.
#pragma once

#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// For every vertex the way to the line where two planes meet, if the points of the faces of its two-ring lie
/// on two planes and the line is nearer than a third of its edges; else 0, as on boundaries and one edge from
/// them. \p variances are those of the points around the vertices; where the root exceeds .15 edges, nothing
/// moves.
///
/// Least squares do not find these places: edges that cut a crease off hold the vertices beside it, and no
/// flip of such an edge gains before a vertex lies on the crease. Two planes are preferred to a smooth
/// surface only if their squared error is well below that of the best quadratic height field, which has as
/// many parameters. The planes are found as clusters of points (k-means with planes; Bradley and Mangasarian,
/// "k-Plane Clustering", 2000). O(points of all two-rings). The result does not depend on the number of
/// threads.
PerVertex<Vector3> moves_to_creases(const Network& network, const Surface& surface,
                                    const PointsByFace& points, const PerVertex<float>& variances,
                                    ThreadTeam& team);

}  // namespace neuralmesh
