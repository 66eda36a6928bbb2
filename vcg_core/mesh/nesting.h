// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which closed components of a mesh lie within which.
#pragma once

#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// For each component the number of closed components around it: around most of it, where one cuts another.
/// \p component is network.components(), \p count the number of components. O(components^2 + faces x the
/// depth)
std::vector<int> nesting_depths(const Network& network, const PerVertex<int>& component, int count);

}  // namespace neuralmesh
