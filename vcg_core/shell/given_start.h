// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A start mesh of the user's own: an earlier result, or a mesh whose webs were cut and gaps bridged by hand.
#pragma once

#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// \p mesh, in the coordinates of the input, as the start mesh for learning \p target, in its frame: the same
/// surface and the same vertices, and a few more where a vertex has more neighbours than a network allows.
/// \throws InputError if it has no faces, is no oriented manifold, or lies apart from the points; the
/// sentence names the first breach and the filter of MeshLab that mends it. O(n log n)
IndexedMesh<float> given_start(const IndexedMesh<double>& mesh, const TargetSpace& target);

}  // namespace neuralmesh
