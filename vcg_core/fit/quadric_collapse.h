// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge collapses in the order of their quadric errors: a reduction that needs no points.
#pragma once

#include <vector>

#include "vcg_core/fit/redistribute.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Reduces \p network to \p vertices vertices by edge collapses, those of least quadric error first. The
/// merged vertex goes to where the error is least; it keeps the id of the end that is nearer. No collapse has
/// a \p barred or a boundary vertex. kCollapseRules of face_rules.h hold, and no valence rises above 10. More
/// vertices remain if no collapse is left that may be carried out. The surface may cut itself afterwards.
/// O(n log n). \return the collapses, in order
///
/// Source: Garland and Heckbert, "Surface simplification using quadric error metrics" (1997), with planes
/// weighted by the areas of the faces.
std::vector<VertexMoves::DoneCollapse> collapse_by_quadrics(Network& network, int vertices,
                                                            const PerVertex<char>& barred);

}  // namespace neuralmesh
