// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What a new vertex on each edge gains in distance to the points.
#pragma once

#include <algorithm>
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

/// What the split of an edge has to gain, as a sum of squared distances of points of weight 1, in variances
/// of their noise. Short edges have to gain more: a new vertex on an edge little longer than the noise
/// crumples the surface, and mostly follows the noise.
struct LeastSplitGain {
    float least = 0;         ///< for any edge, >= 0
    float most = 0;          ///< for any edge, >= least
    float short_length = 0;  ///< in deviations: an edge of this length has to gain twice the least
    float long_length = 0;   ///< longer edges have to gain as much as one of this length

    float of(float squared_length, float variance = 1) const {
        const float squared = std::min(squared_length, long_length * long_length);
        const float squared_short = short_length * short_length * variance;
        return variance * (squared > 0 ? std::min(most, least * (1 + squared_short / squared)) : most);
    }
};

/// The splits of edges that gain at least \p least_gain, most gain first, by linear least
/// squares over the offset of the new vertex from the middle of its edge, along the mean normal of the edge's
/// faces. The new vertex of a boundary edge also follows the edge's BoundaryTarget, which counts the distance
/// between the boundary and where the points end; such an edge is that of a face (a, b, c). \p surface is
/// that of the network, \p variances those of the noise around its vertices (empty: 1). O(points + vertices).
/// The result does not depend on the number of threads.
std::vector<EdgeSplit> find_splits(const Network& network, const Surface& surface, const PointsByFace& points,
                                   const LeastSplitGain& least_gain, ThreadTeam& team,
                                   const PerVertex<float>& variances = {});

}  // namespace neuralmesh
