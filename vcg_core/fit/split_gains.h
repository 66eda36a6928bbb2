// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What a new vertex on each edge gains in distance to the points.
#pragma once

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

/// A new vertex on an edge.
struct EdgeSplit {
    float gain;  ///< drop of the sum of squared distances of the points on the edge's two faces
    VertexId a, b;
    Vector3 position;
};

/// The splits of edges that gain at least \p least_gain, in points of weight 1, times the mean of
/// \p variances at the edge's ends (empty: 1), most gain first, by linear least
/// squares over the offset of the new vertex from the middle of its edge, along the mean normal of the edge's
/// faces. The new vertex of a boundary edge also follows the edge's BoundaryTarget, which counts the distance
/// between the boundary and where the points end; such an edge is that of a face (a, b, c). \p surface is
/// that of the network. O(points + vertices).
/// The result does not depend on the number of threads.
std::vector<EdgeSplit> find_splits(const Network& network, const Surface& surface, const PointsByFace& points,
                                   float least_gain, ThreadTeam& team,
                                   const PerVertex<float>& variances = {});

}  // namespace neuralmesh
