// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which vertex of an earlier network stands for each vertex of a later one: its counters are taken over.
#pragma once

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// For every slot of \p after the vertex of \p before that is nearest to the place of its vertex, so that
/// counters stay where they were learned; -1 for free slots. O(vertices log vertices).
PerVertex<VertexId> nearest_vertices(const Network& before, const Network& after);

}  // namespace neuralmesh
