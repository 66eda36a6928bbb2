// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The constants of a Basic Step.
#pragma once

namespace neuralmesh {

/// By the paper's symbols.
struct StepRates {
    float learning_rate;   ///< alpha_w, in [0, 1]
    float smoothing_rate;  ///< alpha_L, in [0, 1]
    int smoothing_steps;   ///< C_L, at least 0
};

/// Neighbours along a boundary are smoothed by this many times alpha_L. Chosen by open_table.py.
constexpr float kBoundarySteps = 1;

}  // namespace neuralmesh
