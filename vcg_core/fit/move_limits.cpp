// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/move_limits.h"

#include "vcg_core/fit/face_rules.h"

namespace neuralmesh {

namespace {

constexpr float kMaxMove = 0.25F;  ///< in mean lengths of the vertex's edges
constexpr int kHalvings = 5;       ///< of a displacement before it is set to 0

PerFace<Vector3> normals_of(const Surface& surface, const PerVertex<Vector3>& positions) {
    PerFace<Vector3> result(surface.face_count(), Vector3::Zero());
    for (int f = 0; f < result.size(); ++f) result[f] = area_vector(surface.faces[f], positions).normalized();
    return result;
}

float quality_of(const Surface& surface, int f, const PerVertex<Vector3>& positions) {
    const Triangle& face = surface.faces[f];
    return triangle_quality(positions[face[0]], positions[face[1]], positions[face[2]]);
}

/// The face across the edge from corner \p k of \p face to the next, if its number is higher and it has
/// another third corner; -1 if not.
int higher_face_across(const Surface& surface, int face, std::size_t k) {
    const Triangle& own = surface.faces[face];
    const VertexId a = own[k], b = own[(k + 1) % 3], c = own[(k + 2) % 3];
    for (const int other : surface.faces_around(b)) {
        if (other <= face) continue;
        const Triangle& t = surface.faces[other];
        for (std::size_t i = 0; i < 3; ++i)
            if (t[i] == b && t[(i + 1) % 3] == a) return t[(i + 2) % 3] == c ? -1 : other;
    }
    return -1;
}

}  // namespace

MoveLimits::MoveLimits(const Network& network, const Surface& surface)
    : surface_(surface),
      normals_(normals_of(surface, surface.positions)),
      qualities_(normals_.size(), 0),
      folded_(normals_.size(), 0),
      max_move_(network.slot_count(), 0) {
    for (int f = 0; f < normals_.size(); ++f) {
        const Triangle& face = surface_.faces[f];
        qualities_[f] = quality_of(surface_, f, surface_.positions);
        for (std::size_t k = 0; k < 3; ++k)
            if (kMoveRules.is_folded(normals_[f].dot(normal_beyond(surface_, face[k], face[(k + 1) % 3]))))
                folded_[f] = 1;
        for (std::size_t k = 0; k < 3; ++k)
            if (const int other = higher_face_across(surface_, f, k); other >= 0)
                neighbours_.push_back({f, other, normals_[f].dot(normals_[other])});
    }
    for (VertexId v : network.vertices()) {
        float length = 0;
        for (VertexId u : network.ring(v)) length += (surface_.positions[u] - surface_.positions[v]).norm();
        max_move_[v] = kMaxMove * length / static_cast<float>(network.ring(v).valence);
    }
}

/// One set of displacements while it is shortened.
class MoveLimits::Moves {
public:
    Moves(const MoveLimits& limits, const PerVertex<Vector3>& displacements)
        : limits_(limits), surface_(limits.surface_), move_(displacements), moved_(surface_.positions) {
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

    PerVertex<Vector3> shorten_to_limits(CrossingGuard& guard, ThreadTeam& team) {
        // Every pass but the first shortens the moves of few vertices, so it is compared with the one before.
        Surface now = surface_;
        Surface last = surface_;
        std::vector<SelfCrossing> crossings = guard.accepted();
        int crossed = 0;
        for (int pass = 0;; ++pass) {
            if (shorten(find_offending(), pass)) continue;
            now.positions = moved_;
            crossings = update_self_crossings(now, last, crossings, team);
            PerVertex<char> offending(moved_.size(), 0);
            for (VertexId v : guard.objections(crossings)) offending[v] = 1;
            if (!shorten(offending, crossed++)) return std::move(moved_);
            last.positions = now.positions;
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
        }
        return any;
    }

    bool is_spoiled(int face, const PerFace<Vector3>& normals) const {
        if (kMoveRules.turns_over(limits_.normals_[face], normals[face]) && limits_.folded_[face] == 0)
            return true;
        return kMoveRules.is_sliver(limits_.qualities_[face], quality_of(surface_, face, moved_));
    }

    /// Vertices of faces that turn over, become slivers, or fold onto a neighbour.
    PerVertex<char> find_offending() const {
        const PerFace<Vector3> normals = normals_of(surface_, moved_);
        PerVertex<char> offending(moved_.size(), 0);
        const auto mark = [&](int face) {
            for (VertexId v : surface_.faces[face]) offending[v] = 1;
        };
        for (int f = 0; f < normals.size(); ++f)
            if (is_spoiled(f, normals)) mark(f);
        for (const Neighbours& n : limits_.neighbours_)
            if (kMoveRules.folds(n.cosine, normals[n.face].dot(normals[n.other]))) {
                mark(n.face);
                mark(n.other);
            }
        return offending;
    }

    const MoveLimits& limits_;
    const Surface& surface_;
    PerVertex<Vector3> move_;
    PerVertex<Vector3> moved_;
};

PerVertex<Vector3> MoveLimits::bounded(const PerVertex<Vector3>& displacements) const {
    return Moves(*this, displacements).shorten_to_limits();
}

PerVertex<Vector3> MoveLimits::without_crossings(const PerVertex<Vector3>& displacements,
                                                 CrossingGuard& guard, ThreadTeam& team) const {
    return Moves(*this, displacements).shorten_to_limits(guard, team);
}

}  // namespace neuralmesh
