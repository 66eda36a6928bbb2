// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The constants of the learning, with the paper's symbols, and why it ends.
#pragma once

namespace neuralmesh {

/// Which vertices are split (the paper's utility counter, sections 2 and 3): what the winner's counter gets.
enum UtilityCounter : int {
    kNormalVariation = 0,  ///< n_delta of eq 4: the mesh is dense where the surface bends
    kSignalCount = 1,      ///< 1: the mesh is as dense as the cloud
};

/// Why the learning stopped. The values are part of the filter's results: they never change.
enum class StopReason : int {
    target_reached = 0,  ///< the network has the number of vertices asked for
    converged = 1,       ///< the normals turn less per signal than the bound (see eq 8)
    cancelled = 2,       ///< the caller's progress object asked to stop
    cut_short = 3,       ///< the bound on signals was reached before the target
};

/// The constants that users set (settings.h has their ranges).
struct LearningConstants {
    // eq 9: constants with the paper's values.
    double learning_rate = 0.06;    ///< alpha_w, eq 1
    double smoothing_rate = 0.05;   ///< alpha_L
    int smoothing_steps = 5;        ///< C_L
    int signals_per_split = 100;    ///< C_vs; the plan may halve it
    int signals_per_collapse = 10;  ///< C_ec, signals per vertex between two Half-Edge Collapse Steps
    double counter_decay = 0.95;    ///< alpha_nc, after eq 4
    double feature_decay = 0.95;    ///< alpha_fd, eq 6

    int normalization_window = 1000;  ///< C_delta of eq 3, the value of the paper's section 3
    int utility_counter = kNormalVariation;

    // Not in the paper.
    /// Wins since its birth or last split that a vertex needs before it is split: maturity. 0 is the paper to
    /// the letter: no maturity, no batches, no edge flips.
    int min_wins_per_split = 30;
    int settling_signals_per_vertex = 60;  ///< signals after the last split
    int random_seed = 1;
    int threads = 0;  ///< 0: one per core
};

/// The constants, and how far a network grows.
struct GrowthOptions : LearningConstants {
    double stop_below_turn = 0;  ///< alpha_t of eq 8, in degrees as NormalTurn measures; 0: off
    int grow_to = 10000;         ///< vertices at which growth ends
};

}  // namespace neuralmesh
