// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A cloud on one lattice: its points per node, the space it encloses, and its outliers.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/cloud/opposite_layers.h"
#include "vcg_core/start/clearance.h"
#include "vcg_core/start/lattice.h"

namespace neuralmesh {

/// The figures of a cloud on one lattice.
struct Region {
    static constexpr int kMaxRadius = 12;  ///< of the balls, in lattice steps
    static constexpr int kMaxLevel = kMaxRadius * kMaxRadius;
    static constexpr int kMargin = 2;  ///< empty nodes around the box

    Lattice lattice;
    PerNode<std::uint32_t> counts;     ///< points per node, without fringe points
    PerNode<SquaredRadius> distances;  ///< to the nodes with points
    PerNode<SquaredRadius> clearance;  ///< with the enclosed spaces sealed
    bool encloses_space = false;
    double widest_opening = 0;  ///< radius of the widest sealed opening, in the unit of the points; 0: none
    long long total_points = 0;
    long long min_points = 0;     ///< that a component holds
    std::vector<NodeId> hollows;  ///< a node in each
};

/// Examines \p points on a lattice over \p box with nodes \p step apart.
///
/// The fringe of a noisy cloud is left out: nodes with far fewer points than others close by. It would close
/// narrow gaps between surfaces.
///
/// Spaces with an opening of at most kMaxRadius, and 0.6 of their width, are sealed. If there are none, large
/// spaces are sealed whose opening is at most 0.8 times as wide as they are (a head scanned down to the
/// neck), found on a lattice of about 40 steps per side.
///
/// A component holds at least 1 % of the points and at least 20, or a quarter of the points if that is less.
///
/// Hollows, told from the sealed spaces by \p places, are outside as well. O(nodes + points).
Region examine(const std::vector<vcg::Point3f>& points, const vcg::Box3f& box, float step,
               const std::vector<LayerPlace>& places = {});

/// The parts of the surface that are thin or open: the nodes with points that have no enclosed space within
/// two nodes, on any side.
struct ThinParts {
    double share = 0;                ///< of all nodes with points
    std::vector<LayerPlace> places;  ///< those in its nodes
};

/// O(nodes + places).
ThinParts thin_parts(const Region& region, const std::vector<LayerPlace>& places);

/// Points per node of \p lattice; points outside it are not counted. O(nodes + points).
PerNode<std::uint32_t> count_points(const Lattice& lattice, const std::vector<vcg::Point3f>& points);

/// 1 for each outlier; empty if there are none: the points outside \p solid, whose group is too small for a
/// component, or outside the lattice. Fringe points, which examine() leaves out, are never outliers.
/// O(points).
std::vector<std::uint8_t> outliers_of(const std::vector<vcg::Point3f>& points, const Region& region,
                                      const NodeSet& solid);

}  // namespace neuralmesh
