// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The boundary of an open surface: where the points end along it, its notches that the points do not have,
// and faces along it that no points support.
#pragma once

#include <array>
#include <vector>

#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

/// Where points end beside the boundary edge from \p a to \p b. The edge is divided into equal parts.
struct BoundaryTarget {
    static constexpr int kMostParts = 4;

    VertexId a, b;
    int face;         ///< of the edge
    Vector3 outward;  ///< unit vector in the plane of the edge's face, at right angles to the edge
    float length;     ///< of the edge
    float density;    ///< points per area
    float weight;     ///< in (0, 1], less than 1 where there are few points
    int parts;
    /// How far the middle of each part ought to move outward; negative: the points end before the edge.
    std::array<float, kMostParts> offsets;

    /// The place of the middle of part \p i: 0 at a, 1 at b.
    float share(int i) const { return (static_cast<float>(i) + 0.5F) / static_cast<float>(parts); }
    float offset(int i) const { return offsets[static_cast<std::size_t>(i)]; }
};

/// The targets of the boundary edges. In front of each part of an edge, points are followed outward, from one
/// height of the edge's face before the edge, up to a gap that the density of the points makes unlikely. The
/// surface ends beyond the last points by the width that as many points fill at that density, but hardly
/// beyond the very last. O(boundary edges + their points).
std::vector<BoundaryTarget> find_boundary_targets(const Network& network, const Surface& surface,
                                                  const PointsByFace& points);

/// The boundary vertices whose notch Network::fill_notch() ought to fill: it holds about as many points as
/// the density around lets expect, or is too narrow for any. The new face would not fold. O(points around the
/// boundary).
std::vector<VertexId> find_notches(const Network& network, const Surface& surface,
                                   const PointsByFace& points);

/// Fills the \p notches that have no \p barred corner and none in common with an earlier one. \return their
/// number
int fill_notches(Network& network, const std::vector<VertexId>& notches, const PerVertex<char>& barred);

/// Opens the faces at the boundary whose third corner is an inner vertex (Network::open_face) and that hold
/// hardly a point where the density around lets expect many. Each lays the next ones open. Vertices of
/// \p barred stay. O(faces along the boundary + faces opened). \return the number of faces opened
/// \pre \p surface is that of \p network
int open_webs(Network& network, const Surface& surface, const PointsByFace& points,
              const PerVertex<char>& barred);

}  // namespace neuralmesh
