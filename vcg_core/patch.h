// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The geometry of one Basic Step: the winner, its one-ring and what surrounds it, gathered once into a
// small array in which the winner moves, the ring is smoothed and the winner's normal is taken.
#pragma once

#include <vcg/space/point3.h>

#include "lanes.h"
#include "network.h"

namespace neuralmesh {

/// The surroundings of a winner, relative to where the winner stood.
///
/// One sweep of smoothing sees, for a ring vertex r_i, its ring in the order w, r_(i-1), o_1 .. o_m, r_(i+1).
/// Only its two neighbours along the winner's ring move during the sweeps; w and the outer o_j stand still.
/// So what they add to the mean and to the area vector of the star of r_i is summed once, and a sweep costs
/// two cross products and one division per ring vertex, in lanes. (Where three edges bound no face, or a ring
/// vertex has valence 3, an o_j is itself in the ring; it is then seen where it stood before the sweeps.)
///
/// Reused from signal to signal: lanes beyond the valence hold what is left of earlier ones and do not move.
class Patch {
public:
    /// Gathers the surroundings of \p winner. A boundary vertex of the ring is not smoothed: its place along
    /// the boundary is for the signals to say. O(sum of the ring's valences).
    void gather(const Network& network, VertexId winner);

    /// eq 1: v_w <- (1 - alpha_w) v_w + alpha_w s.
    void move_winner(const vcg::Point3f& s, float alpha_w);
    /// C_L sweeps of Laplacian smoothing over the ring, all its vertices at once (Jacobi), in the tangential
    /// direction: L = mean of the neighbours - v, L_t = L - (L.n) n, v <- v + alpha_L L_t.
    void smooth(int sweeps, float alpha_l);
    /// n_w, the sum of the unit normals of the faces around the winner, normalised; 0 if they cancel.
    vcg::Point3f normal();

    int valence() const { return valence_; }
    VertexId winner() const { return winner_; }
    VertexId neighbour(int i) const { return ring_[i]; }
    /// New positions, in the frame of the network.
    vcg::Point3f winner_position() const { return origin_ + winner_at_; }
    vcg::Point3f position(int i) const {
        return origin_ + vcg::Point3f(at_.x[i + 1], at_.y[i + 1], at_.z[i + 1]);
    }

    static constexpr int kLanes = 16;
    /// Component-wise arrays with room for the repeated ends of a cycle.
    struct alignas(32) Vectors {
        float x[kLanes + 8] = {};
        float y[kLanes + 8] = {};
        float z[kLanes + 8] = {};
    };
    /// What does not change during the sweeps, per ring vertex.
    struct Still {
        Vectors sum;    ///< w + o_1 + .. + o_m
        Vectors area;   ///< o_1 x o_2 + .. + o_(m-1) x o_m, relative to w
        Vectors first;  ///< o_1 - w
        Vectors last;   ///< o_m - w
        alignas(32) float inverse_valence[kLanes] = {};
        alignas(32) float rate[kLanes] = {};  ///< alpha_L where the vertex is smoothed, else 0
    };

private:
    void gather_star(const Network& network, int i);

    VertexId winner_ = -1;
    int valence_ = 0;
    int faces_ = 0;
    const VertexId* ring_ = nullptr;
    vcg::Point3f origin_{0, 0, 0};
    vcg::Point3f winner_at_{0, 0, 0};
    /// Lane i + 1 is ring vertex i; lanes 0 and valence + 1 repeat the last and the first.
    Vectors at_;
    Still still_;
    Vectors unit_normals_;
    float moves_[kLanes] = {};  ///< 0: boundary vertex, or no vertex
    /// As gathered: x, y, z in one word each.
    Four points_[kLanes];
    Four sums_[kLanes] = {};
    Four areas_[kLanes] = {};
    Four firsts_[kLanes] = {};
    Four lasts_[kLanes] = {};
};

}  // namespace neuralmesh
