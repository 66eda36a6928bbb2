// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How far the shell is from itself: through a thin wall, or across a narrow gap. A signal is won by the
// nearest vertex, so a start mesh with edges much longer than that gives signals to the wrong side, and walls
// crumple.
#pragma once

#include "vcg_core/mesh/network.h"
#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// For every vertex of \p shell, the surface of \p solid, the smaller of the thickness of the wall behind it
/// and the width of the gap before it, both between the points, which lie \p radius below the shell. At most
/// \p farthest, at least the larger of the radius and 1.5 lattice steps, because no smaller width can be told
/// on the lattice. O(vertices x farthest / step).
PerVertex<float> local_widths(const Network& shell, const Lattice& lattice, const NodeSet& solid,
                              float radius, float farthest);

/// How far the points below each vertex of \p shell may be moved outwards, so that walls thinner than \p
/// thick become thicker, and no wider than the gaps before them: at most half of \p radius. 0 at other walls.
/// \p shell may be coarser than the one that local_widths() takes. O(vertices x thick / step).
PerVertex<float> thickenings(const Network& shell, const Lattice& lattice, const NodeSet& solid, float radius,
                             float thick);

}  // namespace neuralmesh
