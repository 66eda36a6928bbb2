// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Where the surface has creases, from many moments of the learning instead of the final mesh alone.
#pragma once

#include <vcg/space/point3.h>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Measures how creased the surface is at each vertex of a network that learns at fixed connectivity.
///
/// Follows the paper's idea that many reconstructions tell more than one (section 3.1). Instead of eq 6's
/// counter it averages two things over the observed moments: the position of each vertex, and the spread of
/// the face normals around it. From these averages:
/// 1. The face normals of the mean mesh are smoothed (FilteredFaces).
/// 2. Two planes are fitted to the faces of each vertex's two-ring (TwoPlanes): theta is their angle, d the
///    distance of the vertex from their line of intersection, in mean lengths of its edges.
/// 3. The strength of the crease is s = 3 (2 sin(theta / 2))^2 spread^(1/4). With the distance it becomes
///    f = s / (1 + max(s - 1, 1/8) (2 d)^2); if s is above 1, f is 1 at half an edge from the line.
/// 4. If the rounds of the fit changed the mesh, g is the same measure with the planes of the fitted mesh:
///    sharper on clean data, less reliable under noise. Otherwise g = f.
/// 5. The value is sqrt(f^(3/4) g^(1/4)).
///
/// Values are dimensionless, from 0 to 3.5. A value above 1 means that a crease passes within half an edge:
/// this threshold serves all models and noise levels of tests/experiments/paper/features.py. A right-angled
/// edge has about 2; planes, and smooth surfaces that the mesh resolves, stay well below 1. Dividing by the
/// mean, as eq 7 does, would make models less comparable, as the mean depends on how much of a model is
/// crease.
///
/// Memory: 16 bytes per vertex, and about 400 per vertex while values() runs.
class CreaseMeasure {
public:
    /// Adds the present positions as one moment. All moments must have the same connectivity.
    /// O(vertices x valence), a tenth of the time of one signal per vertex.
    void observe(const Network& network, ThreadTeam& team);
    /// Adds the moments of \p other, of the same connectivity. O(vertices).
    void add(const CreaseMeasure& other);
    int moments() const { return moments_; }

    /// The value of every slot of \p shown; 0 for free slots. \p learned is the network observed, \p shown
    /// that after the fit: its vertex v lies near the vertex source[v] of \p learned. Distances are measured
    /// from the positions, and in the edges, of \p shown. If \p source is empty, every vertex has the same id
    /// in both networks, and g = f. Without a moment, the present positions of \p learned count as one. Does
    /// not depend on the number of threads. O(vertices).
    PerVertex<float> values(const Network& learned, const Network& shown, const PerVertex<VertexId>& source,
                            ThreadTeam& team) const;

private:
    PerVertex<vcg::Point3f> position_sums_;
    PerVertex<float> spread_sums_;
    int moments_ = 0;
};

}  // namespace neuralmesh
