// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Thin walls are made thicker while they are learned. The vertex nearest to a signal may be on the other side
// of a wall that is thinner than edges are long; it would be drawn through the wall.
#pragma once

#include <optional>
#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/learning_task.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

/// Moves along the normals of LearningTask::walls, by its thickenings between its vertices. A point of one
/// side of a wall is nearer to that side of the shell, which lies outside of the points, than to the other
/// side; so the nearest face of the shell tells where outside is.
class Thickening {
public:
    /// O(vertices log vertices)
    Thickening(const LearningTask& task, ThreadTeam& team);

    /// The points of \p task, those of thin walls moved outwards; nothing if there are no such walls. For
    /// signals that are drawn from faces or by a sampler it has to outlive the result. O(points log
    /// vertices), on the threads of \p team.
    std::optional<TargetSpace> thicker(const LearningTask& task, ThreadTeam& team) const;

    /// Brings \p network, which has learned thicker(), back to the points: see move_soundly().
    void take_back(Network& network, ThreadTeam& team) const;

private:
    /// At the point nearest to \p hit.
    Vector3 move_at(const Hit& hit) const;
    /// At points near the shell or thicker().
    std::vector<Vector3> moves_at(const std::vector<Vector3>& points, ThreadTeam& team) const;

    std::optional<Surface> shell_;  ///< nothing if there are no thin walls
    PerVertex<Vector3> moves_;      ///< of its vertices
    std::optional<FaceTree> tree_;
};

}  // namespace neuralmesh
