// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Connected components of lattice nodes, kept or dropped by the number of points they hold.
#pragma once

#include <cstdint>

#include "vcg_core/shell/clearance.h"
#include "vcg_core/shell/lattice.h"

namespace neuralmesh {

/// The components of {clearance <= level} that hold at least \p min_points points. O(nodes).
NodeSet solid_of(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                 const PerNode<std::uint32_t>& counts, int level, long long min_points);

}  // namespace neuralmesh
