// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Corridors: ways over a surface that keep clear of all points. A closed one runs around a bridge between two
// parts; a handle of the true surface has points wherever one goes around it.
#pragma once

#include <set>
#include <vector>

#include "vcg_core/target/nearest_points.h"
#include "vcg_core/topology/face_signals.h"
#include "vcg_core/topology/patches.h"

namespace neuralmesh {

/// The places of a surface with no signal near. Keeps references to the surface and the signals.
class Corridors {
public:
    /// \param points as fair as the signals of \p support, but there may be more of them \param edge the mean
    /// edge \param membrane_of at least 0 for the faces that no corridor may lead over.
    /// O((points + faces) log points)
    Corridors(const Surface& surface, const FaceSignals& support, const std::vector<vcg::Point3f>& points,
              float edge, const PerFace<int>& membrane_of);

    /// Whether a corridor leads from an edge of one rim to one of the other. If the rims are then joined, it
    /// is closed, and what it runs around is no handle. O(edges of the rims)
    bool lead(const Rim& from, const Rim& to) const;

    /// The radius of the widest place among \p faces without a point, in spacings of the points around; 10 if
    /// it is wider.
    float widest(const std::vector<int>& faces) const;

private:
    bool is_clear(VertexId a, VertexId b) const;
    float spacing(float signals_per_area) const;
    /// The regions of clear faces to the left of the edges of a rim that are clear.
    std::set<int> regions_at(const Rim& rim) const;

    const Surface& surface_;
    const FaceSignals& support_;
    float edge_;
    float points_per_signal_;
    NearestPoints near_;
    PerFace<int> region_;  ///< faces with the same one are connected over clear edges; -1: of a membrane
};

}  // namespace neuralmesh
