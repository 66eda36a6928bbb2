// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Estimates of the noise of the points.
#pragma once

#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Variance of the points' noise, in squared units of length: the median over the faces of the variance of
/// their points' heights above the face. Misfit of the mesh is common to the points of a face and drops out.
/// 0 if no face has 4 points. O(points + faces).
float noise_variance(const Surface& surface, const PointsByFace& points, ThreadTeam& team);

/// The variance of the points across the surface around each vertex, about the mean of each face, along
/// smoothed normals. O(points + vertices).
PerVertex<float> local_variances(const Network& network, const Surface& surface, const PointsByFace& points);

}  // namespace neuralmesh
