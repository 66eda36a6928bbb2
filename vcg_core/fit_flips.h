// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge flips driven by the points.
#pragma once

#include "fit_solve.h"

namespace neuralmesh {

/// Flips inner edges of \p network, best first and no two with a face in common, where the sum of the squared
/// distances of the points tied to the edge's two faces drops by more than \p least_gain. No face turns over
/// or becomes a sliver. Where the points do not care, the flip that makes the larger of the smallest angles
/// wins. \p surface and \p points are those of the network before. \return the number of flips O(points x 3),
/// on \p threads threads, with the same result for any number of them.
int flip_edges(Network& network, const Surface& surface, const FacePoints& points, float least_gain,
               int threads);

}  // namespace neuralmesh
