// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Basic Steps that one thread computes in a batch.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/simd.h"
#include "vcg_core/engine/eight_steps.h"
#include "vcg_core/engine/slab_schedule.h"
#include "vcg_core/engine/step_rates.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Signals, and the state of the network from which all steps of a batch start.
struct BatchInput {
    const vcg::Point3f* signals;
    int count;
    StepRates rates;
    const Network& network;
    const WinnerSearch& search;
};

/// The steps of the signals in one slab, in the order of the signals. Changes nothing but itself. Aligned, so
/// that no two threads write to the same cache line.
class alignas(64) SlabSteps {
public:
    /// Makes room for \p count steps: all signals of a batch may lie in one slab.
    void reserve(int count);
    /// Takes the signals of \p slab, finds their winners and computes by what each step moves the winner and
    /// its ring. O(signals) expected.
    void compute(const BatchInput& input, const SlabSchedule& schedule, int slab);

    int count() const { return count_; }
    /// Of step k: the index of its signal in the batch, its winner, and delta (see eq 2).
    int signal(int k) const { return signals_[k]; }
    VertexId winner(int k) const { return winners_[k]; }
    float delta(int k) const { return deltas_[k]; }
    /// Displacement [0] is that of the winner of step k, [1 + i] that of its i-th ring vertex.
    const Four* displacements(int k) const { return displacements_.data() + k * kStride; }
    /// Whether step k moves vertices of this slab only. Always true of a batch with one slab.
    bool inside(int k) const { return inside_[k] != 0; }
    /// Number of vertex moves of all steps.
    int moves() const { return moves_; }

private:
    static constexpr int kStride = 1 + Ring::kMaxValence;

    void find_winners(const BatchInput& input, bool out_of_cache);
    void sort_by_valence(const Network& network);
    void compute_group(const BatchInput& input, int slab, const int* group, int size);

    EightSteps eight_;
    int count_ = 0;
    int moves_ = 0;
    Indexed<int> signals_;
    Indexed<VertexId> winners_;
    Indexed<float> deltas_;
    Indexed<Four> displacements_;
    Indexed<int> by_valence_;  ///< steps, sorted by the valences of their winners
    Indexed<std::uint8_t> inside_;
};

}  // namespace neuralmesh
