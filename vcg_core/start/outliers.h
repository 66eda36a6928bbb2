// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Points of a cloud that do not belong to its surface: isolated ones, found once the solid is known.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <vector>

#include "vcg_core/start/lattice.h"
#include "vcg_core/start/region.h"

namespace neuralmesh {

/// 1 for each outlier; empty if there are none. A point is an outlier if it lies outside region.lattice, or
/// if all of these hold:
/// - its group is too small for a component,
/// - it is farther than the radius of \p level from all larger groups,
/// - it lies outside \p solid, or too deep inside to be on the solid's surface.
/// Fringe points, which examine() leaves out, are never outliers. O(points + nodes).
std::vector<std::uint8_t> outliers_of(const std::vector<vcg::Point3f>& points, const Region& region,
                                      const NodeSet& solid, int level);

}  // namespace neuralmesh
