// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The place that a surface was seen from by a sensor, if its points tell.
#pragma once

#include <vcg/space/point3.h>

#include <optional>
#include <utility>
#include <vector>

#include "vcg_core/start/consolidated_points.h"

namespace neuralmesh {

/// Whether \p viewer is the one above of turn_to_viewer(), so far away that lines of sight are parallel.
bool is_above(const std::optional<vcg::Point3f>& viewer);

/// Turns the normals of \p points, which agree within each of the \p parts of Orientation, to the side that
/// the points are seen from: to the first of these from which the surface is single-valued. That is \p
/// sensor, if the density of the points tells one. Then \p origin, the origin of the input, if they fit into
/// the view of a sensor there, no further off than some diagonals: a frame in the coordinates of its sensor.
/// Then +z: terrain, or a flat sheet. Single-valued means that of the area of all parts, each turned to its
/// better side, hardly any is turned away. \p neighbours as for orient_normals(). \return from where they are
/// seen, far away if that is above; nothing if there is no such side: then the normals stay. O(pairs log
/// pairs).
std::optional<vcg::Point3f> turn_to_viewer(const std::vector<std::pair<int, int>>& neighbours,
                                           const std::vector<int>& parts, const vcg::Point3f& origin,
                                           const std::optional<vcg::Point3f>& sensor,
                                           ConsolidatedPoints& points);

}  // namespace neuralmesh
