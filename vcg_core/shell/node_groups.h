// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Connected components of lattice nodes, kept or dropped by the number of points they hold.
#pragma once

#include <vcg/space/box3.h>

#include <cstdint>

#include "vcg_core/shell/clearance.h"
#include "vcg_core/shell/lattice.h"

namespace neuralmesh {

/// The components of {clearance <= level} that hold at least \p min_points points. O(nodes).
NodeSet solid_of(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                 const PerNode<std::uint32_t>& counts, int level, long long min_points);

/// The bounding box of the cells (cubes of one step around a node) of all components of occupied nodes that
/// hold at least the share \p component_share of the points each. Null if these components together hold less
/// than the share \p total_share. O(nodes).
vcg::Box3f box_of_large_groups(const Lattice& lattice, const PerNode<std::uint32_t>& counts,
                               double component_share, double total_share);

}  // namespace neuralmesh
