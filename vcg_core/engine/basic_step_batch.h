// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Many Basic Steps (the paper's section 2) from one state of the network: computed in SIMD lanes and threads,
// then added up in the order of their signals.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/simd.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/engine/eight_steps.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The result of one Basic Step.
struct StepResult {
    VertexId winner;
    float delta;  ///< variation of the winner's normal (see eq 2), in [0, 2]
};

/// Signals, and the state of the network from which all steps of a batch start.
struct BatchInput {
    const vcg::Point3f* signals;
    StepRates rates;
    const Network& network;
    const WinnerSearch& search;
    bool out_of_cache;  ///< many vertices are not in the cache of the core that needs them
};

/// The steps of consecutive signals. Changes nothing but itself. Aligned, so that no two threads write to the
/// same cache line.
class alignas(64) ComputedSteps {
public:
    /// Makes room for \p count steps: compute() runs on threads, where nothing may throw.
    void reserve(int count);
    /// Finds the winners of \p count signals from number \p first on, and computes by what each step moves
    /// the winner and its ring. O(count) expected.
    void compute(const BatchInput& input, int first, int count);

    int count() const { return count_; }
    /// Of step k: its winner, and delta (see eq 2).
    VertexId winner(int k) const { return winners_[k]; }
    float delta(int k) const { return deltas_[k]; }
    /// Displacement [0] is that of the winner of step k, [1 + i] that of its i-th ring vertex.
    const Four* displacements(int k) const { return displacements_.data() + k * kStride; }

private:
    static constexpr int kStride = 1 + Ring::kMaxValence;

    void find_winners(const BatchInput& input, const vcg::Point3f* signals);
    void sort_by_valence(const Network& network);
    void compute_group(const BatchInput& input, const vcg::Point3f* signals, const int* group, int size);

    EightSteps eight_;
    int count_ = 0;
    Indexed<VertexId> winners_;
    Indexed<float> deltas_;
    Indexed<Four> displacements_;
    Indexed<int> by_valence_;  ///< steps, sorted by the valences of their winners
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
