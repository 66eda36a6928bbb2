// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How far points are from a surface: those held out of the fit, which judge it, and all of a target.
#pragma once

#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/triangle.h"

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

/// Root mean square distance of \p target from the nearest faces of \p network, in the core's frame (1 is the
/// diagonal of the bounding box): of all points, each by its weight, if \p target is a cloud of at most
/// \p samples points; else of \p samples random ones. Does not depend on the number of threads. O((faces +
/// samples) log faces) expected. \pre \p network has a face; samples > 0
double rms_distance(const TargetSpace& target, const Network& network, int samples, Random& random,
                    ThreadTeam& team);

/// The same of \p points, in the frame of \p network, by \p weights; empty: all weigh as much. O((faces +
/// points) log faces) expected. \pre \p network has a face; there are points
double rms_distance(const std::vector<Vector3>& points, const std::vector<float>& weights,
                    const Network& network, ThreadTeam& team);

}  // namespace neuralmesh
