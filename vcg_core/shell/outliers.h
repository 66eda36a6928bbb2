// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What of a cloud is the surface: the box it lies in, and which points are outliers.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/shell/region.h"

namespace neuralmesh {

/// The box of the cloud without far outliers: while the groups that hold at least a hundredth of the points
/// each, and nine tenths together, fit into a box half as long, that box is taken. O(points).
vcg::Box3f main_box(const std::vector<vcg::Point3f>& points);

/// The points that belong to no surface, 1 for each; empty if there are none. They lie, with fewer others
/// than make a component, farther from all the rest than the points of a surface do at \p level: outside of
/// \p solid (1: in it), or so deep in it that they are not of its surface. Points that are merely the fringe
/// of a noisy cloud are none. O(points), and O(nodes) if there are any.
std::vector<std::uint8_t> outliers_of(const std::vector<vcg::Point3f>& points, const Region& region,
                                      const std::vector<std::uint8_t>& solid, int level);

}  // namespace neuralmesh
