// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge flips driven by the points.
#pragma once

#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/least_squares.h"

namespace neuralmesh {

/// An edge worth flipping.
struct EdgeFlip {
    float gain;  ///< drop of the sum of squared distances
    VertexId a, b;
};

/// The inner edges of \p network, best first, with which flipped the sum of the squared distances of the
/// points tied to the edge's two faces drops by more than \p least_gain. No face turns over or becomes a
/// sliver. Where the points do not care and the surface is flat, a flip counts with a gain of 0 if it makes
/// the worse of the two faces better by a fifth, in triangle_quality(). \p surface and \p points are those of
/// the network. O(points x 3), by \p team, with the same result for any number of them.
std::vector<EdgeFlip> find_flips(const Network& network, const Surface& surface, const PointsByFace& points,
                                 float least_gain, ThreadTeam& team);

/// Flips those of \p found in their order that have no face in common with one flipped before and no corner
/// that is \p barred (by slot). \return the number of flips
int flip_edges(Network& network, const std::vector<EdgeFlip>& found, const std::vector<char>& barred);

}  // namespace neuralmesh
