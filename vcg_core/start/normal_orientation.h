// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Turns the normals of points to one side of the surface (Hoppe, DeRose, Duchamp, McDonald, Stuetzle,
// "Surface Reconstruction from Unorganized Points", 1992).
#pragma once

#include <vcg/space/point3.h>

#include <utility>
#include <vector>

namespace neuralmesh {

struct Orientation {
    /// For each point the first one of its part: of those that pairs which surely continue each other
    /// connect.
    std::vector<int> parts;
    /// The middles of such pairs whose normals are opposite all the same: the surface has one side only, as a
    /// Moebius strip, or comes too close to itself.
    std::vector<vcg::Point3f> contradictions;
};

/// Turns \p normals, of length 1, so that those of \p neighbours agree along the minimum spanning tree of
/// what they connect: first between points whose planes continue each other, last across walls. Pairs of
/// neighbours may occur twice. O(pairs log pairs).
/// \param sights the directions in which points are seen by a viewer, who is one more neighbour of theirs:
/// first of those whose sight has the greatest part along the normal, up to 1. 0 where there is none; empty:
/// nowhere.
Orientation orient_normals(const std::vector<vcg::Point3f>& positions,
                           const std::vector<std::pair<int, int>>& neighbours,
                           const std::vector<vcg::Point3f>& sights, std::vector<vcg::Point3f>& normals);

}  // namespace neuralmesh
