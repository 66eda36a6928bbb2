// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A cloud on a lattice: where it is, what it encloses, and the topology of that at every radius.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/shell/level_topology.h"

namespace neuralmesh {

/// Everything about one lattice.
struct Region {
    static constexpr int kReach = 12;  ///< radii are examined up to this many lattice steps
    static constexpr int kMargin = 2;  ///< empty nodes around the cloud

    Lattice lattice;
    std::vector<std::uint32_t> counts;  ///< points per node, without the fringe of a noisy cloud
    long long fringe_points = 0;        ///< points left out as that
    std::vector<SquaredRadius> distances;
    std::vector<SquaredRadius> clearance;  ///< with enclosed spaces sealed
    bool encloses_space = false;
    double widest_opening = 0;  ///< radius of the widest hole that was sealed, same unit as the points
    long long total_points = 0;
    long long enough = 0;                   ///< points that make a component
    std::vector<LevelTopology> topologies;  ///< of every level

    /// On which nothing has been looked at yet.
    explicit Region(const Lattice& nodes) : lattice(nodes) {}
};

/// Examines \p points on a lattice over \p box with nodes \p step apart. Two scales of space are sealed: any
/// size where the way in is at most 0.6 of its width and within the reach, and on a lattice of about 40 steps
/// per side those with wide openings. If there is neither, the cloud has a single layer, and large
/// hollows that narrow towards their opening are sealed, too (a head scanned down to the neck).
/// The fringe of a noisy cloud, where it is much thinner than right beside, is left out, because it closes
/// gaps. A component needs \p share of the points and at least \p least. O(nodes + points).
Region examine(const std::vector<vcg::Point3f>& points, const vcg::Box3f& box, float step, double share,
               long long least);

/// Is the solid at \p level still in pieces, as at radii below the distances of the points? That is: nothing
/// is large enough to count, or a twentieth of the points and more lies in pieces too small to count that
/// come together within four lattice steps. O(1).
bool is_fragmented(const Region& region, int level);

float longest_side(const vcg::Box3f& box);

/// Points per lattice node; points outside the lattice are left out.
std::vector<std::uint32_t> count_points(const Lattice& lattice, const std::vector<vcg::Point3f>& points);

/// Mean of the counts that are not 0; 0 if there is none.
double points_per_occupied_node(const std::vector<std::uint32_t>& counts);

}  // namespace neuralmesh
