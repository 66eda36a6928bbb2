// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The constants of the learning, with the paper's symbols.
#pragma once

#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/topology/topology_rules.h"

namespace neuralmesh {

/// What is added to the winner's utility counter.
enum class UtilityIncrement {
    n_delta,  ///< eq 4: the mesh gets denser where the surface bends
    one,      ///< the density of the mesh follows that of the cloud
};

/// The paper's constants, and what it leaves open.
struct LearnerOptions {
    // eq 9: constants with the paper's values.
    double learning_rate = 0.06;    ///< alpha_w
    double smoothing_rate = 0.05;   ///< alpha_L
    int smoothing_steps = 5;        ///< C_L
    int signals_per_split = 100;    ///< C_vs
    int signals_per_collapse = 10;  ///< C_ec, signals per vertex between two Half-Edge Collapse Steps
    double counter_decay = 0.95;    ///< alpha_nc
    double feature_decay = 0.95;    ///< alpha_fd

    // The paper's constants that are not in eq 9.
    int normalization_window = 1000;  ///< C_delta, the value of its section 3
    double stop_below_turn = 0;       ///< alpha_t, in degrees as NormalTurn measures; 0: off
    UtilityIncrement utility_increment = UtilityIncrement::n_delta;

    // Not in the paper.
    int grow_to = 10000;  ///< vertices at which growth ends
    /// Wins since its birth or last split that a vertex needs before it is split. 0 is the paper to the
    /// letter: no maturity, no batches, no edge flips.
    int min_wins_per_split = 30;
    /// Vertices whose mean edge is as short as the points carry there are not split; growth ends when none is
    /// left. Null: as far as grow_to.
    const SurfaceSurvey* noise = nullptr;
    int settling_signals_per_vertex = 60;  ///< signals after the last split
    bool observe_creases = false;          ///< settling fills Learner::crease_measure()
    bool learn_topology = false;           ///< growth gives up membranes, see topology/learned_topology.h
    TopologyRules topology_rules;          ///< with learn_topology
    int random_seed = 1;
    int threads = 0;  ///< 0: one per core
};

}  // namespace neuralmesh
