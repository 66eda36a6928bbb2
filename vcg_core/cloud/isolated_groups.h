// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Small clumps of points away from everything else: see outlier_removal.h.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/base/small_matrices.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

/// An isolated group with a larger share of all points is a component of the surface.
constexpr double kComponentShare = 0.01;

/// How some points, given by their places, lie about their mean.
class Extent {
public:
    Extent(const NearestPoints& cloud, const std::vector<NearestPoints::Place>& points);

    /// The share of the extent that is across it, in [0, 1/3]: 0 for points of a plane or a line, 1/3 for a
    /// ball (the surface variation of Pauly et al. 2002).
    double variation() const;
    /// Whether the points are near a plane: the variance across it beside the least along it.
    bool is_plane() const;
    /// Root mean square distance of the points from that plane.
    double thickness() const;
    /// The distances of \p p from that plane, and from the mean.
    double height(const vcg::Point3f& p) const;
    double distance(const vcg::Point3f& p) const;

private:
    double count_;
    Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
    double trace_ = 0;
    PrincipalAxes spread_;  ///< of the covariance, times the number of points
};

/// Sets \p out at the places of clumps that fill space and are isolated. Places where \p out is set already
/// count as absent. O(n), and O(m log m) for candidates of m points together.
void mark_isolated_clumps(const NearestPoints& cloud, std::vector<std::uint8_t>& out);

}  // namespace neuralmesh
