// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The orientation of the components of a start mesh: which way they face.
#pragma once

#include <vector>

#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The normals of the points near a component.
struct OrientationVote {
    long long along = 0;    ///< of the points whose normals point to the side that it faces
    long long against = 0;  ///< to the other side
    bool open = false;      ///< the component has a boundary

    /// More than six tenths of them point to one side.
    bool is_clear() const;
    double share_along() const;
};

/// The vote on every component of \p network, in the order of Network::components(): about 20,000 points of
/// \p target with a normal each count at their nearest face. Normals nearly along that face do not count.
/// O(points used x log faces). \pre !target.has_faces(), and the network has a face
std::vector<OrientationVote> orientation_votes(const Network& network, const TargetSpace& target);

/// The share of the area of \p network that shows its back to \p viewer. O(faces).
double share_turned_away(const Network& network, const vcg::Point3f& viewer);

/// Turns every component over that is not seen from outside, as a scanner sees it: whose volume, its boundary
/// loops closed by fans around their centres, is negative. O(faces).
void orient_convex_side_outward(Network& network);

/// Turns every component with a boundary over against which \p target has a clear vote, such as inwards if
/// that is where a room is seen from. Closed components stay. \return the number of components with a
/// boundary that had a clear vote
int orient_by_normals(Network& network, const TargetSpace& target);

}  // namespace neuralmesh
