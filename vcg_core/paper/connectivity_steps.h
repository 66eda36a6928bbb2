// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The steps of the paper's section 2 that change the connectivity: Vertex Split and Half-Edge Collapse.
#pragma once

#include <cstdint>
#include <functional>

#include "vcg_core/paper/learning_state.h"

namespace neuralmesh {

/// Splits the mature vertex with the highest utility counter. Where its star cannot be halved, tries the next
/// highest, up to 32. So it does with a vertex that, by \p may_split, is not to be split. \return whether a
/// vertex was split. O(log n).
///
/// How to split follows Ivrissimtzis et al., "Using growing cell structures for surface reconstruction"
/// (2003): from the longest edge e of the star walk equally far both ways to the edges e1 and e2 that halve
/// it; split along e1 and e2; put the new vertex at the midpoint of e.
bool vertex_split(LearningState& state, const std::function<bool(VertexId)>& may_split);

/// Removes the vertices that existed at signal \p since and have not won since then, each by the half-edge
/// collapse that leaves the most regular valences. Vertices without a legal collapse stay, and so do boundary
/// vertices: where the boundary lies beyond the points they win nothing, and collapses along the boundary
/// would leave faces that span its bays. \return the number of vertices removed. O(n).
///
/// The collapse along an edge costs 1/3 sqrt((a + b - 10)^2 + (c - 7)^2 + (d - 7)^2), where a and b are the
/// valences at its ends, c and d those of the vertices opposite to it (Ivrissimtzis et al., "Using growing
/// cell structures for surface reconstruction", 2003).
int half_edge_collapse(LearningState& state, std::int64_t since);

}  // namespace neuralmesh
