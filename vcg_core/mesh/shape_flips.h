// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge flips for better shaped faces where the surface is flat.
#pragma once

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Flips inner edges until no flip that changes the surface by at most \p most, and a hundredth of the new
/// edge, raises the smaller triangle_quality() of its two faces. That change is the distance between the
/// edges before and after the flip. Positions stay. O(vertices) for a pass; few passes do. \return the number
/// of flips
int flip_edges_for_shape(Network& network, float most);

}  // namespace neuralmesh
