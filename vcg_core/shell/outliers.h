// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which points of a cloud are not of its surface: far ones, before a lattice is laid over the cloud, and
// isolated ones, once the solid is known.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/shell/lattice.h"
#include "vcg_core/shell/region.h"

namespace neuralmesh {

/// The bounding box of the cloud without far outliers. The box is replaced by that of the large groups of
/// points as long as that is at most half as long: groups of at least 1 % of the points each that hold 90 %
/// together. O(points).
vcg::Box3f main_box(const std::vector<vcg::Point3f>& points);

/// 1 for each outlier; empty if there are none. Outliers are points outside region.lattice, and points in
/// groups too small for a component that are farther than the radius of \p level from all larger groups and
/// either outside \p solid or so deep inside that they are not of its surface. Fringe points (examine())
/// close to the surface are none. O(points), and O(nodes) if small groups exist.
std::vector<std::uint8_t> outliers_of(const std::vector<vcg::Point3f>& points, const Region& region,
                                      const NodeSet& solid, int level);

}  // namespace neuralmesh
