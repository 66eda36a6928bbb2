// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Turns the normals of points to one side of the surface (Hoppe, DeRose, Duchamp, McDonald, Stuetzle,
// "Surface Reconstruction from Unorganized Points", 1992).
#pragma once

#include <vcg/space/point3.h>

#include <utility>
#include <vector>

namespace neuralmesh {

/// Turns \p normals, of length 1, so that those of \p neighbours agree along the minimum spanning tree of
/// each connected part: first between points whose planes continue each other, last across walls. Pairs of
/// neighbours may occur twice. \return the middles of the pairs that surely continue each other and are
/// opposite all the same: the surface has one side only, as a Moebius strip, or comes too close to itself.
/// O(pairs log pairs).
std::vector<vcg::Point3f> orient_normals(const std::vector<vcg::Point3f>& positions,
                                         const std::vector<std::pair<int, int>>& neighbours,
                                         std::vector<vcg::Point3f>& normals);

}  // namespace neuralmesh
