// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Basic Step of the paper's section 2, for eight signals at once in SIMD lanes. The definition that it is
// tested against takes them one by one (tests/unit/reference/basic_step.h).
#pragma once

#include <vcg/space/point3.h>

#include <algorithm>

#include "vcg_core/base/simd.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The rate at which the winner's two neighbours along a boundary are smoothed. If both move by d, L(v) -
/// L(w), which moves them, falls by 2 d: 0.5 uses it up, and with more they would swing.
inline float rate_along_boundary(float smoothing_rate) { return std::min(0.5F, smoothing_rate); }

/// By the paper's symbols.
struct StepRates {
    float learning_rate;   ///< alpha_w, in [0, 1]
    float smoothing_rate;  ///< alpha_L, in [0, 1]
    int smoothing_steps;   ///< C_L, at least 0

    /// The largest part of its way, to the signal or to the mean of its neighbours, that a step takes a
    /// vertex.
    float largest_share() const {
        float left = 1;
        for (int i = 0; i < smoothing_steps; ++i) left *= 1 - smoothing_rate;
        return std::max({learning_rate, 1 - left, 2 * rate_along_boundary(smoothing_rate)});
    }

    /// Whether steps from one state of the network may be added up. A vertex whose shares add up to more than
    /// 2 ends farther beyond than it was before, and swings ever wider from batch to batch.
    bool may_add_up() const {
        constexpr float kLastingWins = 4;  ///< BatchLimit lets no vertex win more signals of a batch for long
        constexpr float kTooFar = 1.5F;    ///< neighbours that swing against each other go 4/3 as far as one
        return kLastingWins * largest_share() < kTooFar;
    }
};

/// Up to eight Basic Steps from one state of the network, whose winners have the same valence. Call gather(),
/// then move_winners() and smooth(), then displacements(). Positions are relative to those of the winners
/// before the step.
///
/// Smoothing is fast because of what stays constant. The ring of a ring vertex r_i is, in order, the winner
/// w, r_(i-1), outer vertices o_1 .. o_m, r_(i+1). During the smoothing steps only r_(i-1) and r_(i+1) move.
/// So the parts of w and of all o_j in the mean and in the area vector of the star of r_i are summed once,
/// and a smoothing step costs two cross products and one division per ring vertex. (An o_j may itself be in
/// the winner's ring, if three edges bound no face; it then counts with its position before the step.)
class EightSteps {
public:
    static constexpr int kLanes = 8;

    /// Loads the two-rings of \p count winners, 1 to 8 of the same valence.
    /// O(sum of the valences in the winners' rings).
    void gather(const Network& network, const VertexId* winners, int count);

    /// Moves each winner towards its signal; \p signals has kLanes elements.
    void move_winners(const vcg::Point3f* signals, float learning_rate);
    /// Tangential Laplacian smoothing of the winners' rings, and smoothing of the boundary beside winners
    /// that lie on it: by rate_along_boundary(alpha_L) (L(v) - L(w)), where L(v) leads from a vertex to the
    /// middle between its two neighbours on the boundary.
    void smooth(int smoothing_steps, float smoothing_rate);
    /// The present unit normal of each winner: the sum of the unit normals of its faces, normalised; 0 if
    /// they cancel.
    void normals(EightVectors& n) const;

    int valence() const { return valence_; }
    /// Present minus original positions: \p to[lane][0] of the winner, \p to[lane][1 + i] of ring vertex i.
    void displacements(Four* const* to) const;

private:
    static constexpr int kMost = Ring::kMaxValence;
    /// Of the star of one ring vertex in all lanes, what smoothing steps do not change.
    struct Star {
        EightVectors sum;    ///< o_1 + .. + o_m; smooth() adds w
        EightVectors area;   ///< o_1 x o_2 + .. + o_(m-1) x o_m
        EightVectors first;  ///< o_1; smooth() subtracts w
        EightVectors last;   ///< o_m; smooth() subtracts w
        Eight inverse_valence;
        EightInts inner;  ///< -1; 0 for a boundary vertex, which stands still
    };

    /// The two neighbours of a winner along the boundary, the first and the last of its ring.
    struct AlongBoundary {
        int lane;
        /// Half the vectors from where the winner stood to their other neighbours there.
        vcg::Point3f half_way_of_first, half_way_of_last;
    };

    struct Kernels;
    friend struct Kernels;

    int valence_ = 0;
    const Ring* rings_[kLanes] = {};
    VertexId winners_[kLanes] = {};
    EightVectors winner_before_;  ///< the origin of all other positions here
    EightVectors winner_now_;
    EightInts closed_;  ///< -1; 0 for a winner on a boundary, whose ring is open
    Star stars_[kMost];
    AlongBoundary along_boundary_[kLanes];
    int along_boundary_count_ = 0;
    EightVectors ring_before_[kMost];
    /// Entry i + 1 is ring vertex i; entries 0 and valence + 1 repeat the last and the first.
    EightVectors ring_now_[kMost + 2];
};

}  // namespace neuralmesh
