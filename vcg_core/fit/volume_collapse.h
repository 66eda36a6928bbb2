// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge collapses by the shape of the mesh alone, each to the place that keeps the enclosed volume.
#pragma once

#include <vector>

#include "vcg_core/fit/redistribute.h"

namespace neuralmesh {

/// Reduces \p network to \p vertices vertices, or more if no other edge may collapse: the edge that sweeps
/// the least squared volume first, to the place where that is least while the enclosed volume stays. Between
/// places that hardly differ, which is on planes and along straight edges, the mean of the neighbours
/// decides. It compares the mesh with itself as it is then, not with the first one.
///
/// Vertices on a boundary and \p barred ones stay as they are. No face turns over or becomes a sliver
/// (kCollapseRules), no valence rises above 12, and the topology stays; faces may cut others. Removed is the
/// end of the edge that is farther from the place.
/// \param short_length shorter edges collapse sooner, by a hundredth of the squared volume short_length^6 at
/// most. \return what was collapsed, in order
/// Source: Lindstrom and Turk, "Fast and memory efficient polygonal simplification" (1998); the cost is their
/// volume optimization. O(vertices log vertices).
std::vector<DoneCollapse> collapse_by_volume(Network& network, int vertices, const PerVertex<char>& barred,
                                             double short_length = 0);

}  // namespace neuralmesh
