// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which vertex of an earlier network stands for each vertex of a later one: its counters are taken over.
#pragma once

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The sources of a network without inserted vertices: every vertex itself, -1 for free slots.
PerVertex<VertexId> own_sources(const Network& network);

/// The vertex of \p before that is nearest to \p place, as far as a walk from vertex to vertex finds it that
/// begins at \p from and comes nearer with each step. Expected O(valence x steps).
VertexId nearest_by_steps(const Network& before, VertexId from, const vcg::Point3f& place);

/// Of two steps, each with the vertex by its id before for every slot after: the same for both together.
PerVertex<VertexId> chained(const PerVertex<VertexId>& first, PerVertex<VertexId> second);

}  // namespace neuralmesh
