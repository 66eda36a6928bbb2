// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Limits displacements of vertices so that they do not break the surface, and keeps it from cutting itself.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/self_intersections.h"

namespace neuralmesh {

/// Accepts a change of a surface if it adds no self-intersection, or if the number of faces that cross stays
/// at or below its initial value. A default-constructed guard starts from a surface without
/// self-intersections.
class IntersectionGuard {
public:
    IntersectionGuard() = default;
    /// \param intersections self-intersections of the surface, sorted
    explicit IntersectionGuard(std::vector<SelfIntersection> intersections);

    /// Judges a change after which the surface has the self-intersections \p intersections (sorted). \return
    /// empty if the change is accepted, which makes them accepted(); else the corners of the new ones
    std::vector<VertexId> objections(std::vector<SelfIntersection> intersections);

    /// The self-intersections of the surface after the last accepted change.
    const std::vector<SelfIntersection>& accepted() const { return accepted_; }

private:
    std::vector<SelfIntersection> accepted_;
    std::size_t max_faces_ = 0;
};

/// How far the vertices of a surface may move: kMoveRules of face_rules.h hold for its faces, and no vertex
/// moves further than a quarter of the mean length of its edges. Displacements that break a limit are halved
/// up to five times, then set to 0.
class MoveLimits {
public:
    /// Keeps a reference to \p surface, that of \p network; it must not change meanwhile. O(vertices).
    MoveLimits(const Network& network, const Surface& surface, ThreadTeam& team);

    /// The positions after the \p displacements, shortened where they break a limit. O(vertices) per halving.
    PerVertex<Vector3> bounded(const PerVertex<Vector3>& displacements) const;
    /// The same, shortened further until \p guard, which has accepted the surface, accepts the result.
    PerVertex<Vector3> without_intersections(const PerVertex<Vector3>& displacements,
                                             IntersectionGuard& guard, ThreadTeam& team) const;

private:
    class Moves;

    /// Faces with a common edge, and the cosine between their normals before the move.
    struct Neighbours {
        int face, other;
        float cosine;
    };

    void look_across_edges(int face, std::vector<Neighbours>& found);

    const Surface& surface_;
    PerFace<Vector3> normals_;
    PerFace<float> qualities_;
    std::vector<Neighbours> neighbours_;  ///< every pair once
    PerFace<char> folded_;  ///< 1: folded onto a neighbour before the move, so it must be free to turn
    PerVertex<float> max_move_;
};

}  // namespace neuralmesh
