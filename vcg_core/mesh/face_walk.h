// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The nearest face of a point by a walk over the surface from a face near it.
#pragma once

#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// Where a walk begins: at a vertex, with the given one of the faces around it.
struct WalkStart {
    VertexId vertex = 0;
    int turn = 0;  ///< index into faces_around(vertex); one out of range has no effect
};

/// Start of the next walk for the same point: the corner of the hit face nearest to the foot, and that face.
WalkStart walk_start_of(const Surface& surface, const Hit& hit);

/// The nearest face of \p p that a walk finds: it looks at the faces around \p start, goes to the corner
/// nearest to the best foot, and repeats that while the distance falls. May miss the nearest face across a
/// thin gap, where FaceTree does not. Expected O(1) if the start is near.
Hit walk_to_nearest(const Surface& surface, const Vector3& p, WalkStart start);

}  // namespace neuralmesh
