// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Where the faces of a target end.
#pragma once

#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// Diameter of the smallest sphere around the widest boundary of the faces of \p target, in the core's frame;
/// 0 if they have none. Corners at the same place are one vertex, however the layer stores them. Boundaries
/// that touch are one; those that end at an edge of more than two faces are those of fins on a surface, and
/// do not count. O(faces log faces). \pre target.has_faces()
double widest_face_boundary(const TargetSpace& target);

}  // namespace neuralmesh
