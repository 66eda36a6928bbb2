// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The constants of a Basic Step.
#pragma once

#include <algorithm>

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
    /// 2 ends farther beyond than it was before, and swings ever wider from batch to batch; neighbours that
    /// swing against each other go 4/3 as far. BatchLimit lets no vertex win more than four signals of a
    /// batch for long.
    bool may_add_up() const {
        constexpr float kLastingWins = 4, kTooFar = 1.5F;
        return kLastingWins * largest_share() < kTooFar;
    }
};

}  // namespace neuralmesh
