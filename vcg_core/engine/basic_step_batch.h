// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Many Basic Steps (the paper's section 2) from one state of the network: computed in SIMD lanes and threads,
// then added up in the order of their signals.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <cstdint>
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
    int count;
    StepRates rates;
    const Network& network;
    const WinnerSearch& search;
    bool out_of_cache;  ///< many vertices are not in the cache of the core that needs them
};

/// Slabs of space, one for each thread, with about as many signals in each. A thread takes the signals of its
/// slab and moves the vertices there, so that they stay in the cache of its core.
class Slabs {
public:
    static constexpr int kMost = ThreadTeam::kMost;

    /// Makes \p parts of them, with about as many of \p signals in each: if their number changes, and else
    /// every 64 batches, since vertices that change their slab change their cache. O(count log count) then.
    void adapt(const vcg::Point3f* signals, int count, int parts);
    int parts() const { return parts_; }
    int part_of(const vcg::Point3f& p) const {
        int part = 0;
        while (part + 1 < parts_ && p[axis_] >= ends_[part]) ++part;
        return part;
    }

private:
    int parts_ = 1;
    int axis_ = 0;
    int batches_ = 0;  ///< since they were adapted
    float ends_[kMost] = {};  ///< of all but the last, along the axis
};

/// The steps of the signals in one slab. Changes nothing but itself. Aligned, so that no two threads write to
/// the same cache line.
class alignas(64) ComputedSteps {
public:
    /// Makes room for \p count steps: compute() runs on threads, where nothing may throw.
    void reserve(int count);
    /// Finds the winners of the signals in slab \p part, and computes by what each step moves the winner and
    /// its ring. O(signals) expected.
    void compute(const BatchInput& input, const Slabs& slabs, int part);

    int count() const { return count_; }
    /// Of step k: the number of its signal, its winner, and delta (see eq 2).
    int signal(int k) const { return chosen_[k]; }
    VertexId winner(int k) const { return winners_[k]; }
    float delta(int k) const { return deltas_[k]; }
    /// Displacement [0] is that of the winner of step k, [1 + i] that of its i-th ring vertex.
    const Four* displacements(int k) const { return displacements_.data() + k * kStride; }
    /// Whether a vertex that step k moves lies in another slab.
    bool crosses(int k) const { return crosses_[k] != 0; }
    /// The slabs of these vertices, in the order of the displacements; if crosses(k).
    const std::uint8_t* slabs_of(int k) const { return slabs_.data() + k * kStride; }

private:
    static constexpr int kStride = 1 + Ring::kMaxValence;

    void find_winners(const BatchInput& input);
    void sort_by_valence(const Network& network);
    void compute_group(const BatchInput& input, const int* group, int size);
    void find_slabs(const Network& network, const Slabs& slabs, int part);

    EightSteps eight_;
    int count_ = 0;
    Indexed<int> chosen_;  ///< numbers of signals, ascending
    Indexed<vcg::Point3f> signals_;
    Indexed<VertexId> winners_;
    Indexed<float> deltas_;
    Indexed<Four> displacements_;
    Indexed<int> by_valence_;  ///< steps, sorted by the valences of their winners
    Indexed<std::uint8_t> crosses_, slabs_;
};

/// A batch of Basic Steps. All winners are found, and all displacements computed, in the state of the network
/// before the batch; then each vertex is moved by its displacements, in the order of the signals. A batch of
/// one signal is the paper's Basic Step. The number of threads does not change the results.
class BasicStepBatch {
public:
    static constexpr int kMostSignals = 4096;

    /// \p threads: 0 for as many as the machine has.
    explicit BasicStepBatch(int threads)
        : team_(thread_count(threads)),
          parts_(static_cast<std::size_t>(team_.members())),
          changed_(parts_.size()) {}

    /// Takes \p count steps, 1 to kMostSignals. \return their results in the order of the signals, valid
    /// until the next call. O(count) expected.
    const std::vector<StepResult>& take(const vcg::Point3f* signals, int count, const StepRates& rates,
                                        Network& network, WinnerSearch& search);

    /// The threads that compute the batches.
    ThreadTeam& team() { return team_; }

private:
    /// A step: number k of a part.
    struct Step {
        std::uint16_t k;
        std::uint8_t part;
    };

    void compute(const BatchInput& input, int part);
    void move_vertices(int part, const Network& network, WinnerSearch& search);

    ThreadTeam team_;
    Slabs slabs_;
    std::vector<ComputedSteps> parts_;                             ///< by slab
    std::vector<std::vector<WinnerSearch::ChangedCell>> changed_;  ///< by slab
    std::vector<Step> steps_;                                      ///< by signal
    std::vector<StepResult> results_;
};

}  // namespace neuralmesh
