// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moves vertices through the mesh: collapses where they matter little, splits where the error is large.
#pragma once

#include <vector>

#include "vcg_core/fit/collapse_costs.h"
#include "vcg_core/fit/split_gains.h"

namespace neuralmesh {

/// The changes made to a network. An inserted vertex usually gets the id of a removed one.
struct VertexMoves {
    struct DoneCollapse {
        VertexId gone, into;
    };
    struct Insertion {
        VertexId added;
        VertexId beside;  ///< an end of the edge that was split
    };
    std::vector<DoneCollapse> collapses;  ///< in order; all come before the first insertion
    std::vector<Insertion> insertions;    ///< as many as collapses
};

/// Carries out pairs of a collapse and a split, best first, as long as the split gains more than the collapse
/// costs, at most \p max_pairs. No two operations have a vertex in common, and none has a \p barred one.
/// Topology and number of vertices stay.
/// \param collapses of find_collapses() \param splits of find_splits()
VertexMoves redistribute(Network& network, const std::vector<Collapse>& collapses,
                         const std::vector<EdgeSplit>& splits, int max_pairs, const PerVertex<char>& barred);

/// Carries out the best \p splits, at most \p max_count. No two have a corner of their faces in common. The
/// topology stays. \return their number
int insert(Network& network, const std::vector<EdgeSplit>& splits, int max_count);

/// Carries out the cheapest \p collapses, at most \p max_count. No two have a vertex in common, and none has
/// a \p barred one. The topology stays.
std::vector<VertexMoves::DoneCollapse> reduce(Network& network, const std::vector<Collapse>& collapses,
                                              int max_count, const PerVertex<char>& barred);

/// The same with more collapses at once: they may have neighbours in common, but none removes a vertex whose
/// faces, or faces beyond its ring, are new. So the cost of each still holds.
std::vector<VertexMoves::DoneCollapse> reduce_densely(Network& network,
                                                      const std::vector<Collapse>& collapses, int max_count,
                                                      const PerVertex<char>& barred);

}  // namespace neuralmesh
