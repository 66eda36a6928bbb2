// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Where the points end along the boundary of an open surface.
#pragma once

#include <vector>

#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

/// Where points end beside the boundary edge from \p a to \p b.
struct BoundaryTarget {
    VertexId a, b;
    Vector3 outward;  ///< unit vector in the plane of the edge's face, at right angles to the edge
    float weight;     ///< in (0, 1], less than 1 where there are few points
    float offset;     ///< how far it ought to move outward; negative: the points end before the edge
};

/// The targets of the boundary edges. In front of each edge, points are followed outward, from one
/// height of the edge's face before the edge, up to a gap that the density of the points makes unlikely. The
/// surface ends beyond the last points by the width that as many points fill at that density, but hardly
/// beyond the very last. O(boundary edges + their points).
std::vector<BoundaryTarget> find_boundary_targets(const Network& network, const Surface& surface,
                                                  const PointsByFace& points);

/// Points per area around every vertex, over two rings. Faces with a boundary edge do not count: the points
/// beyond the boundary are theirs, too. 0 where there are no other faces. O(vertices).
PerVertex<float> inner_density(const Network& network, const Surface& surface, const PointsByFace& points);

}  // namespace neuralmesh
