// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The geometry of one Basic Step: the winner, its one-ring and what surrounds it, gathered once into a
// small array in which the winner moves, the ring is smoothed and the winner's normal is taken.
#pragma once

#include <vcg/space/point3.h>

#include "network.h"

namespace neuralmesh {

/// The surroundings of a winner, relative to where the winner stood.
///
/// One sweep of smoothing sees, for a ring vertex r_i, its ring in the order w, r_(i-1), o_1 .. o_m, r_(i+1).
/// Only its two neighbours along the winner's ring move during the sweeps; w and the outer o_j stand still.
/// So what they add to the mean (outer_sum) and to the area vector (outer_area) of the star of r_i is
/// summed once, and a sweep costs two cross products and one division per ring vertex, in lanes.
class Patch {
public:
    /// Gathers the surroundings of \p winner. A boundary vertex of the ring is not smoothed: its place along
    /// the boundary is for the signals to say. O(valence^2).
    Patch(const Network& network, VertexId winner);

    /// eq 1: v_w <- (1 - alpha_w) v_w + alpha_w s.
    void move_winner(const vcg::Point3f& s, float alpha_w);
    /// C_L sweeps of Laplacian smoothing over the ring, all its vertices at once (Jacobi), in the tangential
    /// direction: L = mean of the neighbours - v, L_t = L - (L.n) n, v <- v + alpha_L L_t.
    void smooth(int sweeps, float alpha_l);
    /// n_w, the sum of the unit normals of the faces around the winner, normalised; 0 if they cancel.
    vcg::Point3f normal() const;

    int valence() const { return valence_; }
    VertexId winner() const { return winner_; }
    VertexId neighbour(int i) const { return ring_[i]; }
    /// New positions, in the frame of the network.
    vcg::Point3f winner_position() const { return origin_ + winner_at_; }
    vcg::Point3f position(int i) const {
        return origin_ + vcg::Point3f(at_.x[i + 1], at_.y[i + 1], at_.z[i + 1]);
    }

private:
    static constexpr int kLanes = 16;

    /// Lane i + 1 is ring vertex i; lanes 0 and valence + 1 repeat the last and the first.
    struct Vectors {
        float x[kLanes + 4] = {};
        float y[kLanes + 4] = {};
        float z[kLanes + 4] = {};
    };

    void gather_surroundings(const Network& network, int i);
    void close_cycle(Vectors& v) const;

    VertexId winner_;
    int valence_;
    int lanes_;  ///< valence rounded up to whole vectors of 4
    int faces_;
    const VertexId* ring_;
    vcg::Point3f origin_;
    vcg::Point3f winner_at_{0, 0, 0};
    Vectors at_;
    Vectors outer_sum_;
    Vectors outer_area_;
    Vectors outer_first_;  ///< o_1
    Vectors outer_last_;   ///< o_m
    float inverse_valence_[kLanes + 4] = {};
    float moves_[kLanes + 4] = {};  ///< 1 where the vertex is smoothed, else 0
};

}  // namespace neuralmesh
