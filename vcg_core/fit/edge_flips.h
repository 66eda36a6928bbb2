// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge flips that bring the surface closer to the points.
#pragma once

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

/// An edge worth flipping.
struct EdgeFlip {
    float gain;  ///< drop of the sum of squared distances
    VertexId a, b;
};

/// The inner edges worth flipping, best first: those whose flip lowers the sum of squared distances of the
/// points on the edge's two faces by more than \p least_gain times the mean of \p variances at its quad's
/// corners (empty: 1); those whose flip opens a fold; and, with a gain
/// of 0, those on flat surface whose flip hardly changes the distances but raises the smaller
/// triangle_quality() of the two faces by a fifth. kFlipRules of face_rules.h hold. \p surface is that of the
/// network. O(points). The result does not depend on the number of threads.
std::vector<EdgeFlip> find_flips(const Network& network, const Surface& surface, const PointsByFace& points,
                                 float least_gain, ThreadTeam& team, const PerVertex<float>& variances = {});

/// Flips the edges \p found, in their order, leaving out those with a face in common with an earlier flip and
/// those with a \p barred corner. \return the number of flips
int flip_edges(Network& network, const std::vector<EdgeFlip>& found, const PerVertex<char>& barred);

}  // namespace neuralmesh
