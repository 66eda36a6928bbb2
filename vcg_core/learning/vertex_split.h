// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Vertex Split Step of the paper's section 2.
#pragma once

#include "vcg_core/learning/learning_state.h"

namespace neuralmesh {

/// Splits the mature vertex with the highest utility counter. Where its star cannot be halved, tries the next
/// highest, up to 32. So it does with a vertex whose edges are as short as options.noise allows: there noise
/// turns the normals. \return whether a vertex was split. O(log n), and O(log places) with options.noise.
///
/// How to split follows Ivrissimtzis et al., "Using growing cell structures for surface reconstruction"
/// (2003): from the longest edge e of the star walk equally far both ways to the edges e1 and e2 that halve
/// it; split along e1 and e2; put the new vertex at the midpoint of e.
bool vertex_split(LearningState& state);

}  // namespace neuralmesh
