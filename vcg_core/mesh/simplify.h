// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A closed mesh made small and even, its topology kept: for the start mesh, which has thousands of vertices
// too many.
#pragma once

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Collapses the shortest edges of the closed mesh \p network first, until it has at most \p vertices, or
/// nothing can go without changing the topology or folding the surface; then evens it by edge flips and
/// tangential smoothing. All valences end between 3 and 12. O(n log n).
void simplify(Network& network, int vertices);

}  // namespace neuralmesh
