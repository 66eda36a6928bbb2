// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge collapses by the shape of the mesh alone, each to the place that keeps the enclosed volume.
#include <Eigen/LU>

#include <algorithm>
#include <tuple>
#include <utility>

#include "vcg_core/base/lazy_priority_queue.h"
#include "vcg_core/fit/face_rules.h"
#include "vcg_core/fit/redistribute.h"
#include "vcg_core/mesh/flips.h"

namespace neuralmesh {

namespace {

/// Weight of the squared distance from the mean of the neighbours, as a share of the trace of the matrix of
/// squared volumes. With 1e-3, 2,000 vertices have 1.02 times the error; with 1e-5, fandisk has 1.1, because
/// the places follow what is uneven along its sharp edges.
constexpr double kShape = 1e-4;
/// Weight of the squared length of an edge, up to that of short edges. Along a sharp edge the fitted vertices
/// are close together and a little off it, so that it costs more to collapse them than flat faces. Without
/// this, cubes of 400 and 600 vertices have doubled edges in 4 of 16 clouds, and corners cut off. With 0.1,
/// fandisk has 1.25 times the error with 2,000 vertices, because its arcs need short edges.
constexpr double kShortness = 0.01;

using Vector3d = Eigen::Vector3d;

/// Of the faces around a vertex, or around an edge. The volume that a corner at x spans with a face is a
/// sixth of p . (x, 1), where p is the face's area vector and minus its product with one of the corners.
struct FaceSums {
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();  ///< sum of p p^T
    Eigen::Vector4d planes = Eigen::Vector4d::Zero();   ///< sum of p

    void add(const Eigen::Vector4d& p) {
        squares += p * p.transpose();
        planes += p;
    }
    void subtract(const Eigen::Vector4d& p) {
        squares -= p * p.transpose();
        planes -= p;
    }
};

Eigen::Vector4d plane(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const Vector3d normal = (b - a).cross(c - a);
    return {normal[0], normal[1], normal[2], -normal.dot(a)};
}

struct Place {
    Vector3d position;
    double squared_volume;  ///< 36 times what the faces sweep
};

/// The place of least squared volume, and near \p mean, for which the volume as a whole stays.
Place best_place(const FaceSums& sums, const Vector3d& mean) {
    const Eigen::Matrix3d squares = sums.squares.topLeftCorner<3, 3>();
    const double shape = kShape * squares.trace();
    const Eigen::Matrix3d inverse = (squares + shape * Eigen::Matrix3d::Identity()).inverse();
    const Vector3d free = inverse * (shape * mean - sums.squares.topRightCorner<3, 1>());
    const Vector3d normal = sums.planes.head<3>();
    const Vector3d towards = inverse * normal;
    const double slope = normal.dot(towards);
    const double volume = normal.dot(free) + sums.planes[3];
    Vector3d x = slope > 0 ? Vector3d(free - towards * (volume / slope)) : free;
    if (!x.allFinite()) x = mean;  // faces without area
    const Eigen::Vector4d h(x[0], x[1], x[2], 1);
    return {x, std::max(0.0, h.dot(sums.squares * h))};
}

class Reduction {
public:
    Reduction(Network& network, const PerVertex<char>& barred, double short_length)
        : network_(network),
          barred_(barred),
          squared_short_length_(short_length * short_length),
          around_(network.slot_count()),
          changes_(network.slot_count(), 0) {
        for (const VertexId v : network_.vertices()) around_[v] = examine(v);
        for (const VertexId v : network_.vertices())
            for (const VertexId w : network_.ring(v))
                if (v < w) enqueue(v, w);
    }

    std::vector<DoneCollapse> run(int vertices) {
        std::vector<DoneCollapse> done;
        Candidate next;
        while (network_.vertex_count() > vertices &&
               queue_.pop(next, [this](const Candidate& edge) { return is_current(edge); })) {
            const Vector3d where = place(next.a, next.b).position;
            const bool a_is_nearer = (where - at(next.a)).squaredNorm() <= (where - at(next.b)).squaredNorm();
            const VertexId kept = a_is_nearer ? next.a : next.b;
            const VertexId gone = a_is_nearer ? next.b : next.a;
            if (!may_collapse(gone, kept, where.cast<float>())) continue;
            network_.collapse(gone, kept);
            network_.set_position(kept, to_vcg(where.cast<float>()));
            done.push_back({gone, kept});
            update_around(kept);
        }
        return done;
    }

private:
    struct Around {
        FaceSums faces;
        Vector3d neighbours = Vector3d::Zero();  ///< sum of their positions
    };
    /// An edge as it was when its ends had changed so many times together.
    struct Candidate {
        double cost;
        VertexId a, b;
        int changes;
        bool operator<(const Candidate& other) const {
            return std::tie(cost, a, b) < std::tie(other.cost, other.a, other.b);
        }
    };

    Vector3d at(VertexId v) const { return to_eigen(network_.position(v)).cast<double>(); }

    Around examine(VertexId v) const {
        Around result;
        const Ring& ring = network_.ring(v);
        const Vector3d here = at(v);
        for (int i = 0; i < ring.face_count(); ++i)
            result.faces.add(plane(here, at(ring[i]), at(ring.next(i))));
        for (const VertexId w : ring) result.neighbours += at(w);
        return result;
    }

    Place place(VertexId a, VertexId b) const {
        const Ring& ring = network_.ring(a);
        const int i = ring.find_existing(b);
        const Vector3d first = at(a);
        const Vector3d second = at(b);
        FaceSums sums = around_[a].faces;
        sums.squares += around_[b].faces.squares;
        sums.planes += around_[b].faces.planes;
        // The faces at the edge are around both of its ends.
        sums.subtract(plane(first, second, at(ring.next(i))));
        sums.subtract(plane(first, at(ring.previous(i)), second));
        const int neighbours = ring.valence + network_.ring(b).valence - 2;
        return best_place(sums,
                          (around_[a].neighbours + around_[b].neighbours - first - second) / neighbours);
    }

    bool stays(VertexId v) const { return barred_[v] != 0 || network_.ring(v).open != 0; }

    void enqueue(VertexId a, VertexId b) {
        if (a > b) std::swap(a, b);  // so that the cost does not depend on where the edge was seen from
        if (stays(a) || stays(b)) return;
        queue_.push({place(a, b).squared_volume + cost_of_length(a, b), a, b, changes_[a] + changes_[b]});
    }

    /// Of the dimension of a squared volume.
    double cost_of_length(VertexId a, VertexId b) const {
        const double squared = std::min((at(a) - at(b)).squaredNorm(), squared_short_length_);
        return kShortness * squared_short_length_ * squared_short_length_ * squared;
    }

    bool is_current(const Candidate& edge) const {
        return network_.alive(edge.a) && network_.alive(edge.b) &&
               changes_[edge.a] + changes_[edge.b] == edge.changes;
    }

    /// Whether the faces around \p v but those with \p other stay sound if v moves to \p where.
    bool faces_allow(VertexId v, VertexId other, const Vector3& where) const {
        const Ring& ring = network_.ring(v);
        const Vector3 here = to_eigen(network_.position(v));
        for (int i = 0; i < ring.face_count(); ++i) {
            if (ring[i] == other || ring.next(i) == other) continue;
            const Vector3 b = to_eigen(network_.position(ring[i]));
            const Vector3 c = to_eigen(network_.position(ring.next(i)));
            if (kCollapseRules.turns_over(unit_normal(here, b, c), unit_normal(where, b, c)) ||
                kCollapseRules.is_sliver(triangle_quality(here, b, c), triangle_quality(where, b, c)))
                return false;
        }
        return true;
    }

    bool may_collapse(VertexId gone, VertexId kept, const Vector3& where) const {
        return network_.ring(gone).valence + network_.ring(kept).valence - 4 <= kHighestValence &&
               network_.can_collapse(gone, kept) && faces_allow(gone, kept, where) &&
               faces_allow(kept, gone, where);
    }

    /// The faces of \p kept and of its neighbours have changed, and with them the costs of their edges.
    void update_around(VertexId kept) {
        const Ring ring = network_.ring(kept);
        around_[kept] = examine(kept);
        ++changes_[kept];
        for (const VertexId v : ring) {
            around_[v] = examine(v);
            ++changes_[v];
        }
        for (const VertexId v : ring) {
            enqueue(kept, v);
            for (const VertexId w : network_.ring(v)) {
                const bool is_seen_from_both = w == kept || (w < v && ring.find(w) >= 0);
                if (!is_seen_from_both) enqueue(v, w);
            }
        }
    }

    Network& network_;
    const PerVertex<char>& barred_;
    const double squared_short_length_;
    PerVertex<Around> around_;
    PerVertex<int> changes_;
    LazyPriorityQueue<Candidate> queue_;
};

}  // namespace

std::vector<DoneCollapse> collapse_by_volume(Network& network, int vertices, const PerVertex<char>& barred,
                                             double short_length) {
    return Reduction(network, barred, short_length).run(vertices);
}

}  // namespace neuralmesh
