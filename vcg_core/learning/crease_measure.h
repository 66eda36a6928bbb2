// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Where the surface has creases, from many moments of the learning instead of the final mesh alone.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The feature statistic of a network that learns without changing its connectivity.
///
/// The paper's idea, that many reconstructions say more than one (section 3.1), with two statistics in place
/// of the normal counter: the mean position of every vertex over the moments observed, and the mean over the
/// same moments of the spread of the face normals around it. From these, at the end:
/// 1. the face normals of the mean mesh, evened by a few bilateral sweeps, whose width in angle is set by the
///    median angle between adjacent faces, so by the noise;
/// 2. for every vertex the two planes that best explain the faces of its two-ring, the angle theta between
///    them, and the distance d of the vertex from the line where they meet, in mean lengths of its edges;
/// 3. the strength  s = 3 (2 sin(theta / 2))^2 spread^(1/4)  and  f = s / (1 + max(s - 1, 1/8) (2 d)^2),
///    which is 1 at half an edge from the line whatever s is, if it is above 1;
/// 4. where another mesh is shown than was learned, the same from the planes of that: g. It is the sharper of
///    the two on clean clouds, and the less certain under noise;
/// 5. the value  sqrt(f^(3/4) g^(1/4)).
///
/// Values are without dimension, from 0 to 3.5, and comparable between models as they are: dividing by their
/// mean, as eq 7 does, makes them less so, because the mean depends on how much of the model is crease. 1 is
/// a single threshold for all models and noise levels of tests/experiments/paper/features.py: "above 1" reads
/// as "a crease passes within half an edge". A right-angled edge has about 2 on it, a plane or a smooth
/// surface that the mesh resolves stays well below 1.
///
/// Memory: 16 bytes per vertex; values() needs about 400 more per vertex while it runs.
class CreaseMeasure {
public:
    /// Adds the present positions as one moment. All moments must have the same connectivity; to start on
    /// another one, start a new object. O(vertices x valence); called once for as many signals as there are
    /// vertices, it takes about a tenth of the time of those.
    void observe(const Network& network);
    int moments() const { return moments_; }

    /// The value of every slot of \p learned, the network observed; 0 for free slots. If no moment has been
    /// observed, the present one is taken. Deterministic. O(vertices).
    std::vector<float> values(const Network& learned) const;
    /// The same for \p shown, which was made from \p learned by moving, flipping, and moving vertices
    /// elsewhere: vertex v of it lies close to vertex origin[v] of \p learned. Distances are those of the
    /// places and edges in \p shown. An empty \p origin: \p shown is \p learned, perhaps a moment later.
    std::vector<float> values(const Network& learned, const Network& shown,
                              const std::vector<VertexId>& origin) const;

private:
    std::vector<vcg::Point3f> position_sums_;
    std::vector<float> spread_sums_;
    int moments_ = 0;
};

}  // namespace neuralmesh
