// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// One round of least squares: the displacements of the vertices that bring the points closest to the surface,
// each point keeping its nearest face.
#pragma once

#include <Eigen/LU>

#include <array>
#include <cstddef>
#include <vector>

#include "vcg_core/base/simd.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/boundary.h"
#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// A vector for each of four bending weights, one per lane.
struct FourVectors {
    Four x{}, y{}, z{};

    FourVectors& operator+=(const FourVectors& b) {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    /// \p s: a number, or one for each lane
    template <class Scalar>
    friend FourVectors operator*(const Scalar& s, const FourVectors& v) {
        return {s * v.x, s * v.y, s * v.z};
    }
};

/// A symmetric 3x3 matrix: the entries on and above the diagonal, in six numbers where Eigen's takes nine.
template <class Number>
struct Symmetric {
    Number xx{}, xy{}, xz{}, yy{}, yz{}, zz{};

    /// n n^T
    static Symmetric outer(const Vector3& n) {
        return {n[0] * n[0], n[0] * n[1], n[0] * n[2], n[1] * n[1], n[1] * n[2], n[2] * n[2]};
    }
    /// Adds \p s b.
    void add(const Symmetric& b, float s) {
        xx += s * b.xx;
        xy += s * b.xy;
        xz += s * b.xz;
        yy += s * b.yy;
        yz += s * b.yz;
        zz += s * b.zz;
    }
    /// Adds \p s to the diagonal.
    void add_identity(float s) {
        xx += s;
        yy += s;
        zz += s;
    }
    FourVectors operator*(const FourVectors& v) const {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                xz * v.x + yz * v.y + zz * v.z};
    }
    /// \pre regular
    Symmetric inverse() const {
        Eigen::Matrix3f m;
        m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
        m = m.inverse().eval();
        return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
    }
};
using Symmetric3 = Symmetric<float>;

/// The noise of the points around each vertex, and how stiff it makes the surface there. Either may be empty:
/// 0.
struct VertexNoise {
    PerVertex<float> stiffness, variances;
};

/// The normal equations of one round, (A + lambda B) u = f + lambda g, for the displacements u of the
/// vertices. They minimise
///
///   sum over points    w ((n.e)^2 + h |e_t|^2)    e = p - sum_k b_k (x_k + u_k), e_t = e - (n.e) n
/// + sum over edges     (lambda + s_e) c_e |gap_e(x + u)|^2 bending; s_e: stiffness, the mean at the corners
/// + sum over vertices  centring within the tangent plane, and damping, both weak
/// + sum over vertices  a pull to the middle of the ring, for those that lack points
/// + sum over boundary edges     the squared distance of each part from where the points end, outward
/// + sum over boundary vertices  c_v |gap_v(x + u)|^2: the bending of the boundary, which lambda leaves alone
///
/// where a point p has influence w and foot sum_k b_k x_k, and n is the normal of its face, or the direction
/// of e if the foot is on the face's border. n.e is, to first order, the distance of the point from the moved
/// surface, whatever slides along it; this lets vertices move onto creases. The hold h in [0, 1] slows
/// sliding. With h = 1 the distance at the present foot is minimised, so that the surface cannot get farther
/// from the points (Hoppe et al. 1993); with less it can, where it bends and points lie beyond the faces they
/// keep. gap_e is the vector between the points where the two diagonals of the edge's quad cross when the
/// quad is unfolded into the plane: 0 exactly where the surface is flat, whatever the shape of the triangles.
/// c_e falls where the gap is large among the gaps of the mesh, so that creases are not rounded, and longer
/// than the deviation of the points there, which is no crease; c_v does the same at corners of the boundary.
/// Points beyond a boundary edge count by their distance from the plane of its face only: the mean of their
/// distances from the edge would leave it short of their end.
class PointToPlaneSystem {
public:
    /// The hold that makes the blocks regular, but hardly slows sliding.
    static constexpr float kSliding = 0.03F;

    /// Keeps a reference to \p network. \p hold: h, in [0, 1]. O(points + vertices).
    PointToPlaneSystem(const Network& network, const Surface& surface, const PointsByFace& points,
                       ThreadTeam& team, const VertexNoise& noise = {}, float hold = kSliding);

    /// When solve() ends: at the residual \p tolerance relative to that of u = 0, in the norm of the
    /// preconditioner, or after \p iterations. The defaults suit rounds that are repeated with new faces.
    struct Accuracy {
        double tolerance = 1e-2;
        int iterations = 40;
    };
    /// For each of the bending weights \p lambdas (1: a gap weighs as much as the points of one vertex at
    /// that distance) the displacement of every slot, by conjugate gradients preconditioned with the 3x3
    /// diagonal blocks, four weights at a time, as an iteration takes most of its time to read the matrix.
    /// O(vertices) per iteration. The result does not depend on the number of threads.
    std::vector<PerVertex<Vector3>> solve(const std::vector<float>& lambdas, ThreadTeam& team,
                                          const Accuracy& accuracy) const;
    std::vector<PerVertex<Vector3>> solve(const std::vector<float>& lambdas, ThreadTeam& team) const {
        return solve(lambdas, team, Accuracy());
    }

    /// (A + lambda B) u, into \p result, of the same size. O(vertices).
    void multiply(float lambda, const PerVertex<Vector3>& u, ThreadTeam& team,
                  PerVertex<Vector3>& result) const;
    /// f + lambda g.
    PerVertex<Vector3> right_side(float lambda) const;

private:
    /// The bending term of an edge: gap = sum of coefficient x position over the corners.
    struct BendingTerm {
        std::array<VertexId, 4> corner;  ///< the edge's ends, then the two vertices opposite
        std::array<float, 4> coefficient;
        Vector3 gap;
        float weight;         ///< c_e
        float stiffness = 0;  ///< s_e

        /// Adds the part of the term, which counts \p times, in the right side and in the diagonal.
        void add_to(PerVertex<Vector3>& force, PerVertex<float>& diagonal, float times) const {
            for (std::size_t k = 0; k < corner.size(); ++k) {
                const float c = coefficient[k];
                force[corner[k]] -= times * c * gap;
                diagonal[corner[k]] += times * c * c;
            }
        }
    };
    /// The part of a face: blocks of the pairs of corners 00, 11, 22, 01, 12, 20, right sides of the corners.
    struct FaceSums {
        std::array<Symmetric3, 6> pair;
        std::array<Vector3, 3> force;
    };

    /// What an iteration of conjugate gradients changes.
    struct Iteration;
    Iteration first_iteration(const Four& lambdas, ThreadTeam& team) const;
    PerVertex<FourVectors> solutions(const Four& lambdas, const Accuracy& accuracy, ThreadTeam& team) const;
    void multiply(const Four& lambdas, const PerVertex<FourVectors>& u, ThreadTeam& team,
                  std::vector<FourVectors>& forces, PerVertex<FourVectors>& result) const;
    static FaceSums sum_over(const Surface& surface, const PointsByFace& points, float hold, int face);
    void gather(const PerFace<FaceSums>& sums, const Surface& surface, VertexId v);
    void regularise(const Surface& surface, float missing_points, VertexId v);
    static bool make_bending_term(const Surface& surface, const std::array<VertexId, 4>& corner,
                                  BendingTerm& term);
    void add_bending(const Surface& surface, const VertexNoise& noise, ThreadTeam& team);
    void index_terms();
    void add_target(const BoundaryTarget& target);
    void add_boundary_bending(const Surface& surface);
    void centre_along(const Vector3& direction, const Vector3& away, VertexId v);
    Symmetric3* row(VertexId v) { return block_.data() + row_[v]; }
    const Symmetric3* row(VertexId v) const { return block_.data() + row_[v]; }

    const Network& network_;
    float points_per_vertex_;
    // A by block rows, and f.
    PerVertex<std::size_t> row_;  ///< row(v)[i] is the block of v and its neighbour at ring position i
    std::vector<Symmetric3> block_;
    PerVertex<Symmetric3> diagonal_;
    PerVertex<Vector3> force_;
    // B by terms, its diagonal, and g.
    std::vector<BendingTerm> bending_terms_;
    /// A term and the coefficient of a vertex in it.
    struct TermOfVertex {
        std::size_t term;
        float coefficient;
    };
    std::vector<TermOfVertex> terms_by_vertex_;  ///< those of a vertex in the order of the terms
    PerVertex<std::size_t> first_of_terms_;      ///< where those of a vertex begin; one more entry at the end
    std::vector<BendingTerm> boundary_terms_;    ///< of boundary vertices, with three corners; part of A
    PerVertex<float> bending_diagonal_;
    PerVertex<float> stiff_diagonal_;  ///< of the stiffness
    PerVertex<Vector3> bending_force_;
};

}  // namespace neuralmesh
