// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Many Basic Steps (the paper's section 2) from one state of the network: computed in SIMD lanes and threads,
// then added up in the order of their signals.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/engine/computed_steps.h"
#include "vcg_core/engine/step_rates.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The result of one Basic Step.
struct StepResult {
    VertexId winner;
    float delta;  ///< variation of the winner's normal (see eq 2), in [0, 2]
};

/// A batch of Basic Steps. All winners are found, and all displacements computed, in the state of the network
/// before the batch; then each vertex is moved by its displacements, in the order of the signals. A batch of
/// one signal is the paper's Basic Step. The number of threads does not change the results.
class BasicStepBatch {
public:
    static constexpr int kMostSignals = 4096;

    /// \p threads: 0 for as many as the machine has.
    explicit BasicStepBatch(int threads)
        : team_(thread_count(threads)), parts_(static_cast<std::size_t>(team_.members())) {}

    /// Takes \p count steps, 1 to kMostSignals. \return their results in the order of the signals, valid
    /// until the next call. O(count) expected.
    const std::vector<StepResult>& take(const vcg::Point3f* signals, int count, const StepRates& rates,
                                        Network& network, WinnerSearch& search);

    /// The threads that compute the batches.
    ThreadTeam& team() { return team_; }

private:
    void apply(const ComputedSteps& steps, const Network& network, WinnerSearch& search);

    ThreadTeam team_;
    std::vector<ComputedSteps> parts_;  ///< by thread
    std::vector<StepResult> results_;
};

}  // namespace neuralmesh
