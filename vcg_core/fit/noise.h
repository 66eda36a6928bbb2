// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// An estimate of the noise of the points.
#pragma once

#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

/// Variance of the points' noise, in squared units of length: the median over the faces of the variance of
/// their points' heights above the face. Misfit of the mesh is common to the points of a face and drops out.
/// 0 if no face has 4 points. O(points + faces).
float noise_variance(const Surface& surface, const PointsByFace& points, ThreadTeam& team);

}  // namespace neuralmesh
