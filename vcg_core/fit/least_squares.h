// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// One round of least squares: where the vertices should go so that the points, each tied to its nearest face,
// come closest.
#pragma once

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// The points tied to each face.
struct PointsByFace {
    struct Tie {
        Vector3 point;
        float influence;  ///< 1, less for outliers
        Foot foot;
    };
    std::vector<Tie> ties;   ///< face by face
    std::vector<int> first;  ///< of face f: ties[first[f]] up to ties[first[f + 1] - 1]
};

/// A symmetric 3x3 matrix.
struct Symmetric3 {
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    void add(const Symmetric3& b, float s) {
        xx += s * b.xx;
        xy += s * b.xy;
        xz += s * b.xz;
        yy += s * b.yy;
        yz += s * b.yz;
        zz += s * b.zz;
    }
    void add_identity(float s) {
        xx += s;
        yy += s;
        zz += s;
    }
    Vector3 operator*(const Vector3& v) const {
        return {xx * v[0] + xy * v[1] + xz * v[2], xy * v[0] + yy * v[1] + yz * v[2],
                xz * v[0] + yz * v[1] + zz * v[2]};
    }
};

/// The normal equations of one round for the displacements u of the vertices: minimise
///
///   sum over ties  w ((n.e)^2 + kTangential |e_t|^2),  e = p - sum_k b_k (x_k + u_k), n the direction of e
/// + sum over edges  lambda c_e |gap_e(x + u)|^2       bending, see below
/// + sum over vertices  (tangential smoothing and damping, both weak)
/// + sum over vertices  with a star that has far fewer points than its area should have: a pull to the ring's
/// middle
///
/// To first order n.e is the distance of the point from the moved surface, whatever slides along it: this is
/// what lets vertices find creases. gap is the vector between the points where the two diagonals of an edge's
/// quad cross when the quad is unfolded into the plane: zero exactly where the surface is flat, for any shape
/// of the triangles. c_e falls off where the gap is large among the mesh's gaps, so that creases are not
/// rounded.
class PointToPlaneSystem {
public:
    PointToPlaneSystem(const Network& network, const Surface& surface, const PointsByFace& points,
                       ThreadTeam& team);

    /// The displacement of every slot for bending weight \p lambda (relative to the points per vertex), by
    /// conjugate gradients preconditioned with the 3x3 diagonal blocks. O(vertices) per iteration.
    std::vector<Vector3> solve(float lambda) const;

private:
    struct BendingTerm {
        std::array<VertexId, 4> corner;  ///< the edge's ends, then the two vertices opposite
        std::array<float, 4> coefficient;
        float weight;  ///< c_e
    };
    /// Blocks of a face's pairs of corners 00, 11, 22, 01, 12, 20 and right-hand sides of its corners.
    struct FaceSums {
        std::array<Symmetric3, 6> pair;
        std::array<Vector3, 3> force;
    };

    static FaceSums sum_over(const Surface& surface, const PointsByFace& points, int face);
    void gather(const std::vector<FaceSums>& sums, const Surface& surface, VertexId v);
    void regularise(const Surface& surface, VertexId v);
    void measure_support(const Surface& surface, const PointsByFace& points);
    void make_bending_terms(const Surface& surface);
    void multiply(float lambda, const std::vector<Vector3>& u, std::vector<Vector3>& result) const;

    const Network& network_;
    float unit_ = 1;  ///< points per vertex
    std::vector<float>
        missing_;  ///< of slot v: points that its faces should have more, as the density around goes
    std::vector<std::size_t> row_;  ///< of slot v: block_[row_[v]] + i belongs to ring position i
    std::vector<Symmetric3> block_;
    std::vector<Symmetric3> diagonal_;
    std::vector<Vector3> force_;
    std::vector<BendingTerm> bending_terms_;
    std::vector<Vector3> bending_force_;
    std::vector<float> bending_diagonal_;
};

}  // namespace neuralmesh
