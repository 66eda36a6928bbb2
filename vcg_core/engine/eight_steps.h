// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The geometry of eight Basic Steps side by side: the winners, their one-rings and what surrounds them,
// gathered into lanes in which the winners move, the rings are smoothed and the winners' normals are taken.
#pragma once

#include <vcg/space/point3.h>

#include "vcg_core/base/simd.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The surroundings of up to eight winners of one valence, each relative to where its winner stood. The lanes
/// know nothing of each other: eight steps from one state of the network.
///
/// One sweep of smoothing sees, for a ring vertex r_i, its ring in the order w, r_(i-1), o_1 .. o_m, r_(i+1).
/// Only its two neighbours along the winner's ring move during the sweeps; w and the outer o_j stand still.
/// So what they add to the mean and to the area vector of the star of r_i is summed once, and a sweep costs
/// two cross products and one division per ring vertex. (Where three edges bound no face, or a ring
/// vertex has valence 3, an o_j is itself in the ring; it is then seen where it stood before the sweeps.)
class EightSteps {
public:
    static constexpr int kLanes = 8;

    /// Gathers the surroundings of \p count (1 to 8) winners, which must have the same valence. A boundary
    /// vertex of a ring is not smoothed: its place along the boundary is for the signals to say.
    /// O(sum of the rings' valences).
    void gather(const Network& network, const VertexId* winners, int count);

    /// eq 1: v_w <- (1 - alpha_w) v_w + alpha_w s, \p signals one per lane.
    void move_winners(const vcg::Point3f* signals, float alpha_w);
    /// C_L sweeps of Laplacian smoothing over the ring, all its vertices at once (Jacobi), in the tangential
    /// direction: L = mean of the neighbours - v, L_t = L - (L.n) n, v <- v + alpha_L L_t.
    void smooth(int sweeps, float alpha_l);
    /// n_w, the sum of the unit normals of the faces around each winner, normalised; 0 if they cancel.
    void normals(EightVectors& n) const;

    int valence() const { return valence_; }
    /// By what every lane moves its winner and its ring: \p to[lane][0] the winner, \p to[lane][1 + i] ring
    /// vertex i.
    void displacements(Four* const* to) const;

private:
    static constexpr int kMost = Ring::kMaxValence;
    /// What does not change during the sweeps, for ring vertex i of every lane.
    struct Star {
        EightVectors sum;    ///< w + o_1 + .. + o_m
        EightVectors area;   ///< o_1 x o_2 + .. + o_(m-1) x o_m, relative to w
        EightVectors first;  ///< o_1 - w
        EightVectors last;   ///< o_m - w
        Eight inverse_valence;
        EightInts moves;  ///< -1; 0: a boundary vertex
    };

    struct Kernels;
    friend struct Kernels;

    int valence_ = 0;
    const Ring* rings_[kLanes] = {};
    VertexId winners_[kLanes] = {};
    EightVectors origin_;
    EightVectors winner_at_;
    EightInts closed_;  ///< -1; 0: the winner lies on a boundary, its last face is none
    Star stars_[kMost];
    /// As gathered, and now. Entry i + 1 is ring vertex i; 0 and valence + 1 repeat the last and the first.
    EightVectors before_[kMost];
    EightVectors at_[kMost + 2];
};

}  // namespace neuralmesh
