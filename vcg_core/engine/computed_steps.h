// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Basic Steps that one thread computes in a batch.
#pragma once

#include <vcg/space/point3.h>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/simd.h"
#include "vcg_core/engine/eight_steps.h"
#include "vcg_core/engine/step_rates.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

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

}  // namespace neuralmesh
