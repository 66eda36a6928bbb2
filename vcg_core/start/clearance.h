// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which nodes can the centre of a ball reach from outside the lattice while the ball touches no point? One
// number per node, its clearance, answers this for balls of all radii.
//
// All arithmetic is on squared distances in lattice steps, which are integers: exact, and the same on every
// machine.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// In squared lattice steps. Also called a level: the solid at level l is the one for balls of squared radius
/// l.
using SquaredRadius = std::int16_t;

/// Squared distance of every node to the nearest node with occupied != 0, exact up to \p max_radius steps;
/// max_radius^2 + 1 beyond. O(nodes x max_radius), in SIMD.
PerNode<SquaredRadius> squared_distances(const Lattice& lattice, const PerNode<std::uint32_t>& occupied,
                                         int max_radius);

/// The clearance of every node: over all paths to it from outside the lattice, the largest of the smallest
/// squared distances along the path. A ball of squared radius l reaches the nodes with clearance > l; the
/// others are the solid at level l, which has no cavities but the hollows.
///
/// The nodes of \p inside (empty: none) are solid at every level. They grow against the outside as in a
/// watershed transform (Vincent and Soille 1991): nodes reached from inside at a higher level than from
/// outside get clearance 0. The balls also start from the nodes \p hollows, one in each hollow. O(nodes).
PerNode<SquaredRadius> clearances(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                                  int max_radius, const NodeSet& inside,
                                  const std::vector<NodeId>& hollows = {});

struct SealedSpaces {
    NodeSet inside;
    long long nodes = 0;     ///< members of inside
    int widest_opening = 0;  ///< largest squared radius of an opening
};

/// The spaces that are wide compared with their opening. A space is a connected set of nodes with distance >
/// clearance: farther from the points than the radius of any ball that gets there from outside. It is sealed
/// if its largest squared distance is at least \p min_squared_depth and at least width_ratio^2 times the
/// squared radius of the opening. Such a space is the inside of a surface with gaps between its points, or of
/// a scan with holes. O(nodes).
SealedSpaces enclosed_spaces(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                             const PerNode<SquaredRadius>& clearance, double width_ratio,
                             int min_squared_depth);

/// The solid at a level, without its specks: components of fewer points than others need.
struct Solid {
    NodeSet nodes;
    int components = 0;
    long long points_in_specks = 0;
};

/// The components of {clearance <= level} that hold at least \p min_points points. O(nodes).
Solid solid_of(const Lattice& lattice, const PerNode<SquaredRadius>& clearance,
               const PerNode<std::uint32_t>& counts, int level, long long min_points);

}  // namespace neuralmesh
