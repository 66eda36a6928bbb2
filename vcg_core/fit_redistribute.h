// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Takes vertices from where they are of little use to where the error is large.
#pragma once

#include <vector>

#include "fit_solve.h"

namespace neuralmesh {

/// What a redistribution did. The id of a removed vertex is usually used again by an inserted one.
struct Redistribution {
    struct Merge {
        VertexId gone, into;
    };
    struct Insertion {
        VertexId added, beside;  ///< beside: an end of the edge that was split
    };
    std::vector<Merge> merges;          ///< in order, all before the first insertion
    std::vector<Insertion> insertions;  ///< as many
};

/// Pairs the cheapest half-edge collapses with the most rewarding edge splits, no two of which touch, and
/// carries them out as long as a split gains more than the collapse costs, at most \p most pairs. Both are in
/// sums of squared distances of the points: the cost by new feet on the faces that a collapse leaves, the
/// gain by linear least squares over the offset of the new vertex from the middle of its edge, at least \p
/// least_gain. Topology and number of vertices stay. \p surface and \p points are those of the network
/// before. O(points), on \p threads threads, with the same result for any number of them.
Redistribution redistribute(Network& network, const Surface& surface, const FacePoints& points, int most,
                            float least_gain, int threads);

}  // namespace neuralmesh
