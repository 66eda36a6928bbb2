// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/quadric_collapse.h"

#include <Eigen/LU>
#include <algorithm>
#include <queue>
#include <utility>

#include "vcg_core/fit/face_rules.h"

namespace neuralmesh {

namespace {

using Vector3d = Eigen::Vector3d;

constexpr int kMaxValence = 10;  ///< Longer rings leave the later steps no room.
/// Pull to the middle of the edge, in shares of the weight of the planes: on flat surface, and along creases,
/// the planes do not tell the place.
constexpr double kPull = 1e-3;

/// The weighted sum of the squared distances of a place from planes, x'Ax - 2b'x + c.
struct Quadric {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    double c = 0;

    void add_plane(const Vector3d& normal, double offset, double weight) {
        a += weight * normal * normal.transpose();
        b += weight * offset * normal;
        c += weight * offset * offset;
    }
    Quadric& operator+=(const Quadric& other) {
        a += other.a;
        b += other.b;
        c += other.c;
        return *this;
    }
    double at(const Vector3d& x) const { return x.dot(a * x) - 2 * b.dot(x) + c; }
};

/// An edge in the queue, with what its collapse costs and where the merged vertex goes.
struct QueuedEdge {
    float cost;
    VertexId a, b;
    int version;  ///< the sum of those of its ends when the cost was computed
    Vector3 place;

    /// Cheaper edges first. Ties are ordered by ids, so the result does not depend on the queue.
    bool operator<(const QueuedEdge& other) const {
        if (cost != other.cost) return cost > other.cost;
        return std::pair(a, b) > std::pair(other.a, other.b);
    }
};

class QuadricCollapse {
public:
    QuadricCollapse(Network& network, const PerVertex<char>& barred)
        : network_(network),
          barred_(barred),
          quadrics_(network.slot_count()),
          versions_(network.slot_count(), 0) {
        for (const VertexId v : network.vertices()) add_planes(v);
        for (const VertexId v : network.vertices())
            for (const VertexId u : network.ring(v))
                if (v < u) enqueue(v, u);
    }

    std::vector<VertexMoves::DoneCollapse> reduce_to(int vertices) {
        std::vector<VertexMoves::DoneCollapse> done;
        while (network_.vertex_count() > vertices && !queue_.empty()) {
            const QueuedEdge edge = queue_.top();
            queue_.pop();
            if (edge.version != versions_[edge.a] + versions_[edge.b] || !network_.alive(edge.a) ||
                !network_.alive(edge.b) || !may_collapse(edge))
                continue;
            done.push_back(collapse(edge));
        }
        return done;
    }

private:
    Vector3 at(VertexId v) const { return to_eigen(network_.position(v)); }

    /// Those of the faces of which \p v is the smallest corner, to all their corners.
    void add_planes(VertexId v) {
        const Ring& ring = network_.ring(v);
        for (int i = 0; i < ring.face_count(); ++i) {
            if (ring[i] < v || ring.next(i) < v) continue;
            const Vector3d corner = at(v).cast<double>();
            const Vector3d area =
                (at(ring[i]).cast<double>() - corner).cross(at(ring.next(i)).cast<double>() - corner);
            const double twice_area = area.norm();
            if (!(twice_area > 0)) continue;
            const Vector3d normal = area / twice_area;
            for (const VertexId u : {v, ring[i], ring.next(i)})
                quadrics_[u].add_plane(normal, normal.dot(corner), twice_area);
        }
    }

    void enqueue(VertexId v, VertexId u) {
        const VertexId a = std::min(v, u);
        const VertexId b = std::max(v, u);
        if (barred_[a] != 0 || barred_[b] != 0 || network_.ring(a).open != 0 || network_.ring(b).open != 0)
            return;
        Quadric sum = quadrics_[a];
        sum += quadrics_[b];
        const Vector3d middle = 0.5 * (at(a) + at(b)).cast<double>();
        const double pull = kPull * sum.a.trace();
        if (!(pull > 0)) return;
        const Eigen::Matrix3d regular = sum.a + pull * Eigen::Matrix3d::Identity();
        Vector3d place = regular.inverse() * (sum.b + pull * middle);
        if (!((place - middle).squaredNorm() < (at(a) - at(b)).cast<double>().squaredNorm())) place = middle;
        const double cost = sum.at(place) + pull * (place - middle).squaredNorm();
        queue_.push({static_cast<float>(std::max(cost, 0.0)), a, b, versions_[a] + versions_[b],
                     place.cast<float>()});
    }

    bool may_collapse(const QueuedEdge& edge) const {
        return network_.ring(edge.a).valence + network_.ring(edge.b).valence - 4 <= kMaxValence &&
               network_.can_collapse(edge.a, edge.b) && network_.can_collapse(edge.b, edge.a) &&
               keeps_shape(edge.a, edge.b, edge.place) && keeps_shape(edge.b, edge.a, edge.place);
    }

    /// Whether the faces of \p v stay sound when it moves to \p place, but for those that it has in common
    /// with \p other, which go.
    bool keeps_shape(VertexId v, VertexId other, const Vector3& place) const {
        const Ring& ring = network_.ring(v);
        const Vector3 here = at(v);
        for (int i = 0; i < ring.valence; ++i) {
            if (ring[i] == other || ring.next(i) == other) continue;
            const Vector3 a = at(ring[i]);
            const Vector3 b = at(ring.next(i));
            const Vector3 before = unit_normal(here, a, b);
            const Vector3 after = unit_normal(place, a, b);
            const Ring& of_a = network_.ring(ring[i]);
            const VertexId beyond = of_a.previous(of_a.find(ring.next(i)));
            const Vector3 outside = unit_normal(a, beyond == other ? place : at(beyond), b);
            const float fold = before.dot(outside);
            if ((kCollapseRules.turns_over(before, after) && !kCollapseRules.is_folded(fold)) ||
                kCollapseRules.folds(fold, after.dot(outside)) ||
                kCollapseRules.is_sliver(triangle_quality(here, a, b), triangle_quality(place, a, b)))
                return false;
        }
        return true;
    }

    VertexMoves::DoneCollapse collapse(const QueuedEdge& edge) {
        const bool keeps_a =
            (at(edge.a) - edge.place).squaredNorm() <= (at(edge.b) - edge.place).squaredNorm();
        const VertexId kept = keeps_a ? edge.a : edge.b;
        const VertexId gone = keeps_a ? edge.b : edge.a;
        network_.collapse(gone, kept);
        network_.set_position(kept, to_vcg(edge.place));
        quadrics_[kept] += quadrics_[gone];
        ++versions_[kept];
        for (const VertexId u : network_.ring(kept)) enqueue(kept, u);
        return {gone, kept};
    }

    Network& network_;
    const PerVertex<char>& barred_;
    PerVertex<Quadric> quadrics_;
    PerVertex<int> versions_;
    std::priority_queue<QueuedEdge> queue_;
};

}  // namespace

std::vector<VertexMoves::DoneCollapse> collapse_by_quadrics(Network& network, int vertices,
                                                            const PerVertex<char>& barred) {
    return QuadricCollapse(network, barred).reduce_to(vertices);
}

}  // namespace neuralmesh
