// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// All ways to divide rims into parts, each of which one patch closes or joins.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/topology/patches.h"

namespace neuralmesh {

/// Rims in parts, by their indices. A rim alone is closed, the rims of a larger part are joined.
using RimParts = std::vector<std::vector<std::size_t>>;

/// All partitions of so many rims: 1, 2, 5, 15, 52 for 1 to 5 of them.
std::vector<RimParts> partitions(std::size_t rims);

/// Whether \p parts connect all membranes. \p membrane_of: the membrane of every rim.
bool connect_all(const RimParts& parts, std::vector<std::size_t> membrane_of);

/// Euler characteristic of the patches of \p parts: that of spheres with as many holes as the part has rims.
int euler_characteristic(const RimParts& parts);
/// The same of the \p faces inside \p rims. O(faces log faces)
int euler_characteristic(const std::vector<Triangle>& faces, const std::vector<Rim>& rims);

/// The faces of the patches, see patches.h; none if a part gets none.
std::vector<Triangle> patches_of(const RimParts& parts, const std::vector<Rim>& rims,
                                 const PerVertex<Vector3>& positions, const Edges& edges);

}  // namespace neuralmesh
