// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How noisy a cloud is beside the edges of a mesh that is to be made of it.
#pragma once

#include "vcg_core/target/cloud_survey.h"

namespace neuralmesh {

/// Standard deviation of the points about planes through their neighbours, in mean edges of an even mesh with
/// one vertex for \p points_per_vertex points: the median of some 1000 places. A plane is about as wide as
/// such an edge is long, so a surface that the mesh can follow adds little. More than the truth by the bends
/// where a vertex has less than about ten points, and less where the noise is wider than the planes: from
/// some .2 edges on. \p points_per_vertex > 0. O(1).
double noise_in_edges(const CloudSurvey& survey, double points_per_vertex);

}  // namespace neuralmesh
