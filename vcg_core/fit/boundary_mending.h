// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Notches of the boundary that the points do not have, and faces along it that no points support.
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

/// Opens the faces at the boundary whose third corner is an inner vertex (Network::open_face) and that hold
/// hardly a point where the density around lets expect many. Each lays the next ones open. Vertices of
/// \p barred stay. O(faces along the boundary + faces opened). \return the number of faces opened
/// \pre \p surface is that of \p network
int open_webs(Network& network, const Surface& surface, const PointsByFace& points,
              const PerVertex<char>& barred);

}  // namespace neuralmesh
