// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Orders for Network::renumber() that keep vertices near in space near in memory.
#pragma once

#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The used ids of \p network along the Z-order curve of their positions (Morton 1966): near vertices mostly
/// get near places. Positions beyond [-1, 1]^3 count as if on its border. O(n log n).
std::vector<VertexId> morton_order(const Network& network);

/// \p ids, with \p count times -1 (a free id) spread evenly between them: new vertices then find a free id
/// near that of the vertex they are split from. O(ids + count).
/// \pre 0 <= count <= ids.size()
std::vector<VertexId> interleave_free(const std::vector<VertexId>& ids, int count);

}  // namespace neuralmesh
