// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Notches of the boundary that the points do not have.
#pragma once

#include <vector>

#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

/// The boundary vertices whose notch Network::fill_notch() ought to fill: it holds about as many points as
/// the density around lets expect, or is too narrow for any. The new face would not fold. O(points around the
/// boundary).
std::vector<VertexId> find_notches(const Network& network, const Surface& surface,
                                   const PointsByFace& points);

/// Fills the \p notches that have no \p barred corner and none in common with an earlier one. \return their
/// number
int fill_notches(Network& network, const std::vector<VertexId>& notches, const PerVertex<char>& barred);

}  // namespace neuralmesh
