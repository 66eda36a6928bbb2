// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moves halved until no face turns over, folds, becomes a sliver or cuts another.
#include "vcg_core/fit/move_limits.h"

namespace neuralmesh {

namespace {

constexpr float kLongestMove = 0.25F;   ///< in mean lengths of the vertex's edges
constexpr float kLeastTurn = 0.3F;      ///< cosine between a face's normals before and after
constexpr float kSharpestFold = -0.6F;  ///< cosine between the normals of neighbouring faces
constexpr float kSliver = 0.06F;        ///< triangle_quality() below which a face may not fall
constexpr int kHalvings = 5;            ///< before the vertices of an offending face stay where they are

std::vector<Vector3> normals_of(const Surface& surface, const std::vector<Vector3>& at) {
    std::vector<Vector3> result(surface.faces.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const Triangle& f = surface.faces[i];
        result[i] = area_vector(at[index(f[0])], at[index(f[1])], at[index(f[2])]).normalized();
    }
    return result;
}

}  // namespace

MoveLimits::MoveLimits(const Network& network, const Surface& surface)
    : network_(network),
      surface_(surface),
      normals_(normals_of(surface, surface.at)),
      folded_(normals_.size()),
      longest_(surface.at.size()) {
    for (std::size_t i = 0; i < normals_.size(); ++i) {
        const Triangle& f = surface_.faces[i];
        for (std::size_t k = 0; k < 3; ++k)
            if (normals_[i].dot(normal_beyond(surface_, f[k], f[(k + 1) % 3])) < kSharpestFold)
                folded_[i] = 1;
    }
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        const Ring& ring = network.ring(v);
        if (ring.valence == 0) continue;
        float length = 0;
        for (int i = 0; i < ring.valence; ++i)
            length += (surface_.at[index(ring[i])] - surface_.at[index(v)]).norm();
        longest_[index(v)] = kLongestMove * length / static_cast<float>(ring.valence);
    }
}

/// One set of displacements, and what becomes of it within the limits.
class MoveLimits::Mover {
public:
    Mover(const MoveLimits& limits, const std::vector<Vector3>& u)
        : limits_(limits), surface_(limits.surface_), move_(u), moved_(surface_.at) {
        for (std::size_t v = 0; v < moved_.size(); ++v) {
            const float bound = limits.longest_[v];
            const float norm = move_[v].norm();
            if (norm > bound) move_[v] *= bound / norm;
            if (!(norm >= 0)) move_[v].setZero();
            moved_[v] += move_[v];
        }
    }

    // Every pass sets at least one more vertex to rest once the halvings are used up, and no move at all is
    // always allowed; so these loops end.
    std::vector<Vector3> run() {
        for (int pass = 0;; ++pass)
            if (!shorten(find_offending(), pass)) return std::move(moved_);
    }

    std::vector<Vector3> run(CrossingGuard& guard, ThreadTeam& team) {
        Surface now = surface_;
        const std::vector<Crossing> at_start = guard.standing();
        int crossed = 0;
        for (int pass = 0;; ++pass) {
            if (shorten(find_offending(), pass)) continue;
            now.at = moved_;
            std::vector<char> offending(moved_.size(), 0);
            for (const VertexId v : guard.objections(crossings_after(now, surface_, at_start, team)))
                offending[index(v)] = 1;
            if (!shorten(offending, crossed++)) return std::move(moved_);
        }
    }

private:
    /// \return whether any of the \p offending vertices moved at all
    bool shorten(const std::vector<char>& offending, int pass) {
        bool any = false;
        for (std::size_t v = 0; v < moved_.size(); ++v) {
            if (offending[v] == 0 || move_[v] == Vector3(0, 0, 0)) continue;
            any = true;
            if (pass < kHalvings) {
                move_[v] *= 0.5F;
            } else {
                move_[v].setZero();
            }
            moved_[v] = surface_.at[v] + move_[v];
        }
        return any;
    }

    bool spoiled(std::size_t i, const std::vector<Vector3>& now) const {
        if (limits_.normals_[i].dot(now[i]) < kLeastTurn && limits_.folded_[i] == 0) return true;
        const Triangle& f = surface_.faces[i];
        const auto quality = [&](const std::vector<Vector3>& at) {
            return triangle_quality(at[index(f[0])], at[index(f[1])], at[index(f[2])]);
        };
        const float after = quality(moved_);
        return after < kSliver && after < 0.9F * quality(surface_.at);
    }

    /// Vertices of faces that turn over, become slivers, or fold onto a neighbour.
    std::vector<char> find_offending() const {
        const std::vector<Vector3> now = normals_of(surface_, moved_);
        std::vector<char> offending(moved_.size(), 0);
        const auto mark = [&](std::size_t face) {
            for (const VertexId v : surface_.faces[face]) offending[index(v)] = 1;
        };
        for (std::size_t i = 0; i < now.size(); ++i)
            if (spoiled(i, now)) mark(i);
        for (VertexId v = 0; v < limits_.network_.slot_count(); ++v) {
            // The faces of a vertex that share an edge with it share that edge's other end.
            for (int i = surface_.first_face[index(v)]; i < surface_.first_face[index(v) + 1]; ++i) {
                const auto f = index(surface_.face_of[index(i)]);
                for (int j = i + 1; j < surface_.first_face[index(v) + 1]; ++j) {
                    const auto g = index(surface_.face_of[index(j)]);
                    const float fold = now[f].dot(now[g]);
                    if (fold >= kSharpestFold || fold >= limits_.normals_[f].dot(limits_.normals_[g]) ||
                        !share_edge(f, g))
                        continue;
                    mark(f);
                    mark(g);
                }
            }
        }
        return offending;
    }

    bool share_edge(std::size_t f, std::size_t g) const {
        int shared = 0;
        for (const VertexId a : surface_.faces[f])
            for (const VertexId b : surface_.faces[g]) shared += a == b ? 1 : 0;
        return shared == 2;
    }

    const MoveLimits& limits_;
    const Surface& surface_;
    std::vector<Vector3> move_;
    std::vector<Vector3> moved_;
};

std::vector<Vector3> MoveLimits::bounded(const std::vector<Vector3>& u) const {
    return Mover(*this, u).run();
}

std::vector<Vector3> MoveLimits::uncrossed(const std::vector<Vector3>& u, CrossingGuard& guard,
                                           ThreadTeam& team) const {
    return Mover(*this, u).run(guard, team);
}

}  // namespace neuralmesh
