// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Estimates of the noise of the points, and outliers close to the surface. Distances between points do not
// show these; heights above a mesh do.
#pragma once

#include "vcg_core/base/thread_team.h"
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

/// Tells stray points by their heights above a surface.
///
/// A point is astray if it is much farther from the surface than the points around are (their spread, a high
/// quantile of their distances), and if hardly any of the points nearest to it has a comparable height on the
/// same side. The points of a part that the mesh has not reached yet are all far. Points beyond a boundary
/// stay, too: the mesh grows towards them.
class StrayPoints {
public:
    /// Points are astray from \p deviations times the spread on, if the noise is normal in standard
    /// deviations. Keeps references to \p surface and \p points. O(points + vertices).
    StrayPoints(const Network& network, const Surface& surface, const PointsByFace& points, float deviations,
                ThreadTeam& team);

    /// Whether \p point, one of the points, is astray. \p face is its face. O(1); for points far from the
    /// surface O(points of the faces around).
    bool contain(const PointsByFace::Assignment& point, int face) const;

private:
    float height(const PointsByFace::Assignment& point, int face) const;
    bool has_company(const PointsByFace::Assignment& point, int face) const;

    const Surface& surface_;
    const PointsByFace& points_;
    PerVertex<float> limit_;  ///< least distance of stray points
};

}  // namespace neuralmesh
