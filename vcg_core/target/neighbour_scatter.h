// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How a point and its neighbours spread: the matrix of which the plane through them is an eigenvector.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vcg_core/target/nearest_points.h"

namespace neuralmesh {

/// Sum of the outer products of the differences of the point at \p place and the points \p near it to their
/// mean. O(near)
Eigen::Matrix3d neighbour_scatter(const NearestPoints& cloud, NearestPoints::Place place,
                                  const std::vector<NearestPoints::Neighbour>& near);

}  // namespace neuralmesh
