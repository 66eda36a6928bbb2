// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What the learning is given: the paper's constants, and what a run decides beside them.
#pragma once

#include "vcg_core/paper/constants.h"
#include "vcg_core/topology/learned_topology.h"

namespace neuralmesh {

class SurfaceSurvey;

struct LearnerOptions : GrowthOptions {
    /// Vertices whose mean edge is as short as the points carry there are not split; growth ends when none is
    /// left. Null: as far as grow_to.
    const SurfaceSurvey* noise = nullptr;
    bool observe_creases = false;  ///< settling fills Learner::crease_measure()
    bool learn_topology = false;   ///< growth gives up membranes, see topology/learned_topology.h
    TopologyRules topology_rules;  ///< with learn_topology
};

}  // namespace neuralmesh
