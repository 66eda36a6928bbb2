// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What the removal of each vertex costs in distance to the points.
#pragma once

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/fit/support.h"

namespace neuralmesh {

/// The cheapest half-edge collapse of a vertex.
struct Collapse {
    static constexpr float kForbidden = Support::kForbidden;  ///< which costs are added up with

    float cost;  ///< rise of the sum of squared distances of the points
    VertexId gone;
    VertexId into;  ///< -1 and a cost of kForbidden: the vertex cannot go, or was not examined
};

/// The cheapest collapse of every slot, cheapest first. Examines two fifths of the vertices, those with the
/// smallest quadric errors, and for each the three neighbours of smallest quadric error. Each cost is
/// measured on about 64 points of the star, by their distances from the faces that replace it. kCollapseRules
/// of face_rules.h hold. \p surface is that of the network. O(vertices log vertices). The result does not
/// depend on the number of threads.
std::vector<Collapse> find_collapses(const Network& network, const Surface& surface,
                                     const PointsByFace& points, ThreadTeam& team);

}  // namespace neuralmesh
