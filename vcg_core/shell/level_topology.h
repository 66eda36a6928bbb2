// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Components and handles of the solids at all levels, counted in one pass over the lattice.
#pragma once

#include <cstdint>

#include "vcg_core/shell/clearance.h"
#include "vcg_core/shell/lattice.h"

namespace neuralmesh {

/// Topology of the solid at one level.
struct LevelTopology {
    int components = 0;          ///< of at least min_points points
    int specks = 0;              ///< components of fewer points
    long long speck_points = 0;  ///< points in the specks
    int genus = 0;               ///< handles of components and specks together
};

/// One value for every level, from 0 to max_radius^2.
template <class T>
using PerLevel = Indexed<T>;

/// The topology of {clearance <= l} for every level l from 0 to max_radius^2, where \p counts[i] points lie
/// at node i. O(nodes).
PerLevel<LevelTopology> topology_of_levels(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                                           const PerNode<std::uint32_t>& counts, int max_radius,
                                           long long min_points);

/// Euler characteristic of the simplices all of whose nodes are in \p solid: components - handles + cavities.
/// O(nodes).
int euler_characteristic(const Lattice& lattice, const NodeSet& solid);

}  // namespace neuralmesh
