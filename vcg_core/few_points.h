// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The surface between points that are too few to tell it: their convex hull, if all of them lie on it.
#pragma once

#include <optional>

#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/indexed_mesh.h"

namespace neuralmesh {

/// A surface as what is learned and as the mesh of it.
struct ConvexSurface {
    TargetSpace target;  ///< has faces, and colours if the cloud has
    /// In the frame of the target. Empty if there are more points than vertices, or a vertex of the hull has
    /// more neighbours than a network allows.
    IndexedMesh<float> mesh;
};

/// The convex hull of the points of \p cloud with \p vertices vertices, evenly spread. Nothing if there are
/// more than 1,000 points, if one is farther inside of the hull than a tenth of the mean spacing or, unless
/// \p thin_too, if the hull is thin beside the distances of its points. If all points are corners of the
/// hull, it is bent where it turns little from one to the next; sharp edges, as those of a box of 8 points,
/// stay. By vcglib's quickhull (Barber et al. 1996). O(points x faces + vertices log vertices)
/// \pre !cloud.has_faces()
std::optional<ConvexSurface> convex_surface(const TargetSpace& cloud, int vertices, bool thin_too = false);

}  // namespace neuralmesh
