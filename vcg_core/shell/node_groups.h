// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Groups of adjacent nodes of a lattice, and how many points they hold.
#pragma once

#include <vcg/space/box3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/shell/level_topology.h"

namespace neuralmesh {

/// The nodes of the solid at \p level, without the components of fewer than \p enough points.
std::vector<std::uint8_t> solid_of(const Lattice& lattice, const std::vector<SquaredRadius>& clearance,
                                   const std::vector<std::uint32_t>& counts, int level, long long enough);

/// The box of all groups of adjacent occupied nodes that hold at least \p share of the points each; null if
/// they do not hold \p together of the points. O(nodes).
vcg::Box3f box_of_large_groups(const Lattice& lattice, const std::vector<std::uint32_t>& counts, double share,
                               double together);

}  // namespace neuralmesh
