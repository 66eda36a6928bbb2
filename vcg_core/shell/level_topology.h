// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Components and handles of the solids at all levels, counted in one pass over the lattice.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/shell/clearance.h"
#include "vcg_core/shell/lattice.h"

namespace neuralmesh {

/// Topology of the solid at one level.
struct LevelTopology {
    int components = 0;          ///< of at least min_points points
    int specks = 0;              ///< components of fewer points
    long long speck_points = 0;  ///< points in the specks
    int cavities = 0;            ///< hollows that balls of this level fit into
    int genus = 0;               ///< handles of components and specks together

    /// Components of the solid's surface: its outer ones, and one around each cavity.
    int surfaces() const { return components + cavities; }
};

/// One value for every level, from 0 to max_radius^2.
template <class T>
using PerLevel = Indexed<T>;

/// The topology of {clearance <= l} for every level l from 0 to max_radius^2, where \p counts[i] points lie
/// at node i; the solids' cavities are around the nodes \p hollows. O(nodes).
PerLevel<LevelTopology> topology_of_levels(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
                                           const PerNode<std::uint32_t>& counts, int max_radius,
                                           long long min_points, const std::vector<NodeId>& hollows = {});

/// Euler characteristic of the simplices all of whose nodes are in \p solid: components - handles + cavities.
/// O(nodes).
int euler_characteristic(const Lattice& lattice, const NodeSet& solid);

}  // namespace neuralmesh
