// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What keeps a solution of the least squares from breaking the surface.
#pragma once

#include <vector>

#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// How far the vertices of a surface may move. No face turns over, folds onto its neighbour or becomes a
/// sliver, and no vertex moves further than a quarter of the way to its neighbours.
class MoveLimits {
public:
    /// References to the arguments are kept; they have to stay what they are. O(vertices)
    MoveLimits(const Network& network, const Surface& surface);

    /// The positions by slot after the displacements \p u, shortened where they break a limit.
    std::vector<Vector3> bounded(const std::vector<Vector3>& u) const;
    /// The same, shortened on until \p guard, which stands for the surface, has no objections.
    std::vector<Vector3> uncrossed(const std::vector<Vector3>& u, CrossingGuard& guard,
                                   ThreadTeam& team) const;

private:
    class Mover;

    const Network& network_;
    const Surface& surface_;
    std::vector<Vector3> normals_;
    std::vector<char> folded_;  ///< faces that lie folded back, so have to turn to come right
    std::vector<float> longest_;
};

}  // namespace neuralmesh
