// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Takes vertices from where they are of little use to where the error is large, or out.
#pragma once

#include <vector>

#include "vcg_core/fit/least_squares.h"

namespace neuralmesh {

/// What a redistribution did. The id of a removed vertex is usually used again by an inserted one.
struct VertexMoves {
    struct DoneCollapse {
        VertexId gone, into;
    };
    struct Insertion {
        VertexId added, beside;  ///< beside: an end of the edge that was split
    };
    std::vector<DoneCollapse> merges;   ///< in order, all before the first insertion
    std::vector<Insertion> insertions;  ///< as many
};

/// The cheapest half-edge collapse of a vertex.
struct Collapse {
    float cost;  ///< rise of the sum of squared distances of the points
    VertexId gone, into;
};
/// A new vertex on an edge.
struct EdgeSplit {
    float gain;  ///< drop of the sum of squared distances
    VertexId a, b;
    Vector3 where;
};
struct Redistribution {
    std::vector<Collapse> mergers;  ///< cheapest first
    std::vector<EdgeSplit> splits;  ///< most rewarding first
};

/// The cheapest collapse of every vertex, cheapest first, its cost by new feet on the faces that it leaves.
/// \p surface and \p points are those of the network. O(points), by \p team, with the same result for any
/// number of threads.
std::vector<Collapse> plan_reduction(const Network& network, const Surface& surface,
                                     const PointsByFace& points, ThreadTeam& team);

/// The same, and the gains of splits, of at least \p least_gain, by linear
/// least squares over the offset of the new vertex from the middle of its edge. \p surface and \p points are
/// those of the network. O(points), by \p team, with the same result for any number of them.
Redistribution plan_redistribution(const Network& network, const Surface& surface, const PointsByFace& points,
                                   float least_gain, ThreadTeam& team);

/// Pairs collapses with splits, no two of which touch each other or a vertex that is \p barred (by slot),
/// and carries them out as long as a split gains more than the collapse costs, at most \p most pairs.
/// Topology and number of vertices stay.
VertexMoves redistribute(Network& network, const Redistribution& plan, int most,
                         const std::vector<char>& barred);

/// Carries out the cheapest collapses, no two of which touch each other or a vertex that is \p barred, at
/// most \p most. Topology stays.
std::vector<VertexMoves::DoneCollapse> reduce(Network& network, const std::vector<Collapse>& mergers,
                                              int most, const std::vector<char>& barred);

}  // namespace neuralmesh
