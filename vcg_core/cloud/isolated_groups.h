// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Small clumps of points away from everything else: see outlier_removal.h.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/cloud/nearest_points.h"

namespace neuralmesh {

/// The share of a neighbourhood's extent that is across it, in [0, 1/3]: 0 for points of a plane or a line,
/// 1/3 for a ball (the surface variation of Pauly et al. 2002). \p points are the places looked at.
double surface_variation(const NearestPoints& cloud, const std::vector<NearestPoints::Place>& points);

/// Does \p place lie in the plane of \p others, which are all near one plane?
bool continues_plane(const NearestPoints& cloud, NearestPoints::Place place,
                     const std::vector<NearestPoints::Place>& others);

/// How far \p place is from the plane of \p others: its distance over the greater of their own (root mean
/// square) and \p at_least. 0 if they are not near one plane.
double relative_plane_distance(const NearestPoints& cloud, NearestPoints::Place place,
                               const std::vector<NearestPoints::Place>& others, double at_least);

/// Sets \p out at the places of clumps that fill space and are isolated. Places where \p out is set already
/// count as absent. O(n), and O(m log m) for candidates of m points together.
void mark_isolated_clumps(const NearestPoints& cloud, std::vector<std::uint8_t>& out);

}  // namespace neuralmesh
