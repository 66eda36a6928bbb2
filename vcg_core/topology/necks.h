// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Necks: places where a handle is as thin as a triangle or a quadrangle.
#pragma once

#include <vector>

#include "vcg_core/topology/membranes.h"

namespace neuralmesh {

/// The faces around each closed chain of three or four edges, as a tube with two rims. The chain bounds no
/// face, no edge divides it, and it runs around a handle: the surface is connected without it. The faces lack
/// kTubeLack. What is left of a bridge between two parts is such a tube: signals of both parts support its
/// ends, so it may have no membrane. Only chains at faces without support are looked at. \p network: the one
/// of \p surface. O(faces + faces without support x valence^3 + chains that lack support x faces)
std::vector<Membrane> find_necks(const Network& network, const Surface& surface, const FaceSignals& signals);

}  // namespace neuralmesh
