// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A mesh of the user's own as a network can hold it: the start mesh of learning, such as an earlier result or
// a mesh whose webs were cut by hand, or a mesh whose counters are asked for.
#pragma once

#include <vector>

#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/indexed_mesh.h"

namespace neuralmesh {

/// What the user knows the mesh as, in the sentences on its breaches.
enum class GivenAs {
    start_layer,
    current_layer,
};

struct GivenStart : IndexedMesh<float> {
    /// Per vertex its index in the user's mesh. A vertex that was added has that of the one it was split
    /// from.
    std::vector<int> sources;
};

/// \p mesh, in the coordinates of the input, as the start mesh for learning \p target, in its frame: the same
/// surface and the same vertices without those that no face uses, and a few more where a vertex has more
/// neighbours than a network allows.
/// \throws InputError if it has no faces, is no oriented manifold, or lies apart from the points; the
/// sentence names the first breach and the filter of MeshLab that mends it. O(n log n)
GivenStart given_start(const IndexedMesh<double>& mesh, const TargetSpace& target,
                       GivenAs role = GivenAs::start_layer);

}  // namespace neuralmesh
