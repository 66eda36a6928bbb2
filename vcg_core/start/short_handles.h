// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Handles of a start mesh that are too short to be seen: strands between parts that come close, and tunnels.
#pragma once

#include <vector>

#include "vcg_core/mesh/indexed_mesh.h"

namespace neuralmesh {

/// Cuts the handles of the oriented manifold \p mesh around or through which a loop of at most \p edges edges
/// leads that does not separate it: removes the faces at the vertices of the loop. The holes stay. At most
/// some hundred handles are looked for. \p source: a number for each vertex, kept in step. \return how many
/// were cut. O(handles x faces).
int cut_short_handles(IndexedMesh<float>& mesh, int edges, std::vector<int>& source);

}  // namespace neuralmesh
