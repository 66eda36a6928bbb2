// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Membranes that have to go together: those over several openings of one hollow.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/topology/membranes.h"

namespace neuralmesh {

/// Groups of three and more certain membranes, by their indices, each near to another of its group. If a
/// group has more than \p most_rims rims, only those of its membranes that lack the most signals. The
/// membranes of a group come in this order. \p edge: mean length. O(product of the lengths of all rims)
std::vector<std::vector<int>> membrane_groups(const Surface& surface, const std::vector<Membrane>& membranes,
                                              float edge, std::size_t most_rims);

/// Leaves faces out of membranes until no two of them share a vertex: at a vertex that two share, all faces
/// but those of the first. \return false if that leaves a membrane without faces
bool take_apart(const Surface& surface, const FaceSignals& signals, std::vector<Membrane>& membranes);

}  // namespace neuralmesh
