// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// An order for Network::renumber() that keeps vertices near in space near in memory.
#pragma once

#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The used ids of \p network along the Z-order curve of their positions (Morton 1966): near vertices mostly
/// get near places. Positions beyond [-1, 1]^3 count as if on its border. O(n log n).
std::vector<VertexId> morton_order(const Network& network);

}  // namespace neuralmesh
