// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// More vertices than the points carry: the longest edges are split.
#pragma once

#include "vcg_core/base/progress.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Where refine() puts the new vertices.
enum class NewVertices {
    on_edges,  ///< adds no self-crossing
    curved,    ///< the surface curves by the normals at the ends of the edges
    between,   ///< the same, but it curves only where the normals turn by little
};

/// Splits edges of \p network, the longest first, until it has \p vertices vertices or no edge can be
/// split. O(n log n) for every doubling of the vertices. \p progress is asked before each pass. \return the
/// number of vertices inserted
int refine(Network& network, int vertices, NewVertices where, Progress& progress);

}  // namespace neuralmesh
