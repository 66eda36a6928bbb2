// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Faces along the boundary that no points support.
#pragma once

#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

/// Opens the faces at the boundary whose third corner is an inner vertex (Network::open_face) and that hold
/// hardly a point where the density around lets expect many. Each lays the next ones open. Vertices of
/// \p barred stay. O(faces along the boundary + faces opened). \return the number of faces opened
/// \pre \p surface is that of \p network
int open_webs(Network& network, const Surface& surface, const PointsByFace& points,
              const PerVertex<char>& barred);

}  // namespace neuralmesh
