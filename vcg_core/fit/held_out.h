// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The points held out of the fit, which judge it.
#pragma once

#include <vector>

#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

/// Measures how far surfaces are from points that took no part in the fit. Distances are measured along a
/// fixed direction per point, the smoothed normal of a reference surface. The nearest distance would not do:
/// under noise a crumpled surface is nearer to every point than the true one. A copy keeps its directions, so
/// it can compare two surfaces along the same ones.
class HeldOut {
public:
    explicit HeldOut(TrackedPoints points) : tracked_(std::move(points)) {}

    /// Finds the points on \p surface, exactly, and reorders them; set_directions() must follow.
    /// O(points x log faces).
    void locate(const Surface& surface, ThreadTeam& team);
    /// The same, but keeps order and directions: for a \p surface of other connectivity.
    void relocate(const Surface& surface, ThreadTeam& team);
    /// From now on measures along the smoothed normals of \p surface, the surface of \p network. Expected
    /// O(points + vertices).
    void set_directions(const Network& network, const Surface& surface, ThreadTeam& team);
    /// Root mean square distance of the points from \p surface along their directions; each distance counts
    /// up to \p outlier_distance and with the weight of its point. Expected O(points).
    double rms_error(const Surface& surface, float outlier_distance, ThreadTeam& team) const;

    TrackedPoints& tracked() { return tracked_; }

private:
    TrackedPoints tracked_;
    std::vector<Vector3> directions_;
};

}  // namespace neuralmesh
