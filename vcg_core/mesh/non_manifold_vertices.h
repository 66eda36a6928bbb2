// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Clean-ups that make a list of oriented faces a manifold mesh.
#pragma once

#include <vector>

#include "vcg_core/mesh/indexed_mesh.h"

namespace neuralmesh {

/// Gives every fan of faces around a vertex, but for the first, a vertex of its own. \p source, one number
/// for each vertex, is copied for the new ones. \pre no edge has more than two faces. O(faces).
void split_non_manifold_vertices(IndexedMesh<float>& mesh, std::vector<int>& source);

/// Drops vertices without faces, and their entries of \p source. O(vertices + faces).
void drop_unused_vertices(IndexedMesh<float>& mesh, std::vector<int>& source);

}  // namespace neuralmesh
