// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Decimation of a closed mesh to evenly sized triangles. Used to reduce the shell, which has thousands of
// vertices more than a start mesh needs.
#pragma once

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Reduces the closed mesh \p network to at most \p vertices vertices by half-edge collapses, the shortest
/// edges first, and evens it by edge flips and tangential smoothing: to equal edges, or to edges in
/// proportion to \p lengths, one for each vertex, as far as it can be. Preserves the topology; if no further
/// collapse does, more vertices remain. No valence rises above 12. O(n log n).
void simplify(Network& network, int vertices, const PerVertex<float>& lengths = {});

}  // namespace neuralmesh
