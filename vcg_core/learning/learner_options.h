// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What the learning is given: the constants that users set, and what a run decides.
#pragma once

#include "vcg_core/learning/learning_constants.h"
#include "vcg_core/topology/learned_topology.h"

namespace neuralmesh {

class SurfaceSurvey;

/// The constants, and what a run decides about the learning.
struct LearnerOptions : LearningConstants {
    double stop_below_turn = 0;  ///< alpha_t of eq 8, in degrees as NormalTurn measures; 0: off
    int grow_to = 10000;         ///< vertices at which growth ends
    /// Vertices whose mean edge is as short as the points carry there are not split; growth ends when none is
    /// left. Null: as far as grow_to.
    const SurfaceSurvey* noise = nullptr;
    bool observe_creases = false;  ///< settling fills Learner::crease_measure()
    bool learn_topology = false;   ///< growth gives up membranes, see topology/learned_topology.h
    TopologyRules topology_rules;  ///< with learn_topology
};

}  // namespace neuralmesh
