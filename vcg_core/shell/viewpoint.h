// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The place that a surface was seen from by a sensor, if its points tell.
#pragma once

#include <vcg/space/point3.h>

#include <utility>
#include <vector>

#include "vcg_core/shell/consolidated_points.h"

namespace neuralmesh {

/// Turns the normals of \p points, which agree within each of the \p parts of Orientation, to the side that
/// the points are seen from. That is \p origin, the origin of the input, if they fit into the view of a
/// sensor there, no further off than some diagonals, and the surface is single-valued as seen from there: a
/// frame in the coordinates of its sensor. Else it is +z, if the surface is single-valued from above:
/// terrain, or a flat sheet. Single-valued means that of the area of all parts, each turned to its better
/// side, hardly any is turned away. \p neighbours as for orient_normals(). \return false if there is no such
/// side: then the normals stay. O(pairs log pairs).
bool turn_to_viewer(const std::vector<std::pair<int, int>>& neighbours, const std::vector<int>& parts,
                    const vcg::Point3f& origin, ConsolidatedPoints& points);

}  // namespace neuralmesh
