// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Half-Edge Collapse Step of the paper's section 2.
#pragma once

#include <cstdint>

#include "vcg_core/learning/learning_state.h"

namespace neuralmesh {

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
