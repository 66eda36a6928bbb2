// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/move_limits.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/face_rules.h"

namespace neuralmesh {

namespace {

std::size_t count_faces(const std::vector<SelfIntersection>& intersections) {
    std::vector<Triangle> faces;
    for (const SelfIntersection& c : intersections) {
        faces.push_back({c[0], c[1], c[2]});
        faces.push_back({c[3], c[4], c[5]});
    }
    std::sort(faces.begin(), faces.end());
    return static_cast<std::size_t>(std::unique(faces.begin(), faces.end()) - faces.begin());
}

constexpr float kMaxMove = 0.25F;  ///< in mean lengths of the vertex's edges
constexpr int kLimitChunk = 512;
constexpr int kHalvings = 5;  ///< of a displacement before it is set to 0

float quality_of(const Surface& surface, int f, const PerVertex<Vector3>& positions) {
    const Triangle& face = surface.faces[f];
    return triangle_quality(positions[face[0]], positions[face[1]], positions[face[2]]);
}

}  // namespace

IntersectionGuard::IntersectionGuard(std::vector<SelfIntersection> intersections)
    : accepted_(std::move(intersections)), max_faces_(count_faces(accepted_)) {}

std::vector<VertexId> IntersectionGuard::objections(std::vector<SelfIntersection> intersections) {
    std::vector<SelfIntersection> added;
    std::set_difference(intersections.begin(), intersections.end(), accepted_.begin(), accepted_.end(),
                        std::back_inserter(added));
    std::vector<VertexId> corners;
    if (added.empty() || count_faces(intersections) <= max_faces_) {
        accepted_ = std::move(intersections);
    } else {
        for (const SelfIntersection& intersection : added)
            corners.insert(corners.end(), intersection.begin(), intersection.end());
    }
    return corners;
}

MoveLimits::MoveLimits(const Network& network, const Surface& surface, ThreadTeam& team)
    : surface_(surface),
      normals_(surface.face_count(), Vector3::Zero()),
      qualities_(surface.face_count(), 0),
      folded_(surface.face_count(), 0),
      max_move_(network.slot_count(), 0) {
    parallel_for(surface.face_count(), kLimitChunk, team, [&](int f) {
        normals_[f] = unit_normal(surface_, f);
        qualities_[f] = quality_of(surface_, f, surface_.positions);
    });
    neighbours_ = parallel_collect<Neighbours>(
        surface.face_count(), kLimitChunk, team,
        [this](int f, std::vector<Neighbours>& found) { look_across_edges(f, found); });
    parallel_for(network.slot_count(), kLimitChunk, team, [&](VertexId v) {
        if (network.alive(v))
            max_move_[v] = kMaxMove * mean_edge_length_at(surface_.positions, network.ring(v), v);
    });
}

/// Tells whether \p face is folded onto a neighbour, and appends its neighbours of higher numbers.
void MoveLimits::look_across_edges(int face, std::vector<Neighbours>& found) {
    const Triangle& own = surface_.faces[face];
    for (std::size_t k = 0; k < 3; ++k) {
        const FaceCorner across = corner_of_edge(surface_, own[(k + 1) % 3], own[k]);
        if (across.face < 0) continue;
        const float cosine = normals_[face].dot(normals_[across.face]);
        if (kMoveRules.is_folded(cosine)) folded_[face] = 1;
        const bool same_corners = surface_.faces[across.face][(across.corner + 2) % 3] == own[(k + 2) % 3];
        if (across.face > face && !same_corners) found.push_back({face, across.face, cosine});
    }
}

/// One set of displacements while it is shortened.
class MoveLimits::Moves {
public:
    Moves(const MoveLimits& limits, const PerVertex<Vector3>& displacements)
        : limits_(limits),
          surface_(limits.surface_),
          move_(displacements),
          moved_(surface_.positions),
          normals_(surface_.face_count(), Vector3::Zero()),
          is_new_(moved_.size(), 1) {
        for (VertexId v = 0; v < moved_.size(); ++v) {
            const float bound = limits.max_move_[v];
            const float length = move_[v].norm();
            if (length > bound) move_[v] *= bound / length;
            if (!(length >= 0)) move_[v].setZero();  // not a number
            moved_[v] += move_[v];
        }
    }

    // Once the halvings are used up, every pass sets at least one more displacement to 0, and the surface
    // without any displacement breaks no limit; so these loops end.
    PerVertex<Vector3> shorten_to_limits() {
        for (int pass = 0;; ++pass)
            if (!shorten(find_offending(), pass)) return std::move(moved_);
    }

    /// \param guard has accepted the surface before the move
    PerVertex<Vector3> shorten_to_limits(IntersectionGuard& guard, ThreadTeam& team) {
        Surface last = surface_, now = surface_;
        std::vector<SelfIntersection> intersections = guard.accepted();
        int crossed = 0;
        for (int pass = 0;; ++pass) {
            if (shorten(find_offending(), pass)) continue;
            // Every pass but the first shortens the moves of few vertices.
            if (moved_ != last.positions) {
                now.positions = moved_;
                intersections = update_self_intersections(now, last, intersections, team);
                last.positions = moved_;
            }
            PerVertex<char> offending(moved_.size(), 0);
            for (VertexId v : guard.objections(intersections)) offending[v] = 1;
            if (!shorten(offending, crossed++)) return std::move(moved_);
        }
    }

private:
    /// \return whether any of the \p offending vertices had a displacement left
    bool shorten(const PerVertex<char>& offending, int pass) {
        bool any = false;
        for (VertexId v = 0; v < moved_.size(); ++v) {
            if (offending[v] == 0 || move_[v] == Vector3(0, 0, 0)) continue;
            any = true;
            if (pass < kHalvings) {
                move_[v] *= 0.5F;
            } else {
                move_[v].setZero();
            }
            moved_[v] = surface_.positions[v] + move_[v];
            is_new_[v] = 1;
        }
        return any;
    }

    bool is_spoiled(int face) const {
        if (kMoveRules.turns_over(limits_.normals_[face], normals_[face]) && limits_.folded_[face] == 0)
            return true;
        if (surface_.turns_away(limits_.normals_[face], normals_[face], surface_.corner(face, 0)))
            return true;
        return kMoveRules.is_sliver(limits_.qualities_[face], quality_of(surface_, face, moved_));
    }

    /// Vertices of faces that turn over, become slivers, or fold onto a neighbour. Faces whose corners are
    /// where they were at the last call are not examined: the moves of their vertices were shortened then.
    PerVertex<char> find_offending() {
        PerVertex<char> offending(moved_.size(), 0);
        const auto mark = [&](int face) {
            for (VertexId v : surface_.faces[face]) offending[v] = 1;
        };
        PerFace<char> is_new(normals_.size(), 0);
        for (int f = 0; f < normals_.size(); ++f) {
            const Triangle& face = surface_.faces[f];
            is_new[f] = is_new_[face[0]] | is_new_[face[1]] | is_new_[face[2]];
            if (is_new[f] == 0) continue;
            normals_[f] = area_vector(face, moved_).normalized();
            if (is_spoiled(f)) mark(f);
        }
        is_new_.assign(moved_.size(), 0);
        for (const Neighbours& n : limits_.neighbours_) {
            if ((is_new[n.face] | is_new[n.other]) == 0) continue;
            if (!kMoveRules.folds(n.cosine, normals_[n.face].dot(normals_[n.other]))) continue;
            mark(n.face);
            mark(n.other);
        }
        return offending;
    }

    const MoveLimits& limits_;
    const Surface& surface_;
    PerVertex<Vector3> move_;
    PerVertex<Vector3> moved_;
    PerFace<Vector3> normals_;  ///< after the moves that find_offending() has seen
    PerVertex<char> is_new_;    ///< 1: find_offending() has not seen the vertex where it is
};

PerVertex<Vector3> MoveLimits::bounded(const PerVertex<Vector3>& displacements) const {
    return Moves(*this, displacements).shorten_to_limits();
}

PerVertex<Vector3> MoveLimits::without_intersections(const PerVertex<Vector3>& displacements,
                                                     IntersectionGuard& guard, ThreadTeam& team) const {
    return Moves(*this, displacements).shorten_to_limits(guard, team);
}

}  // namespace neuralmesh
