// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Several Basic Steps (the paper's section 2) from one state of the network: computed side by side, in lanes
// and threads, and then added to the network in the order of their signals.
#pragma once

#include <cstdint>
#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/engine/axis_partition.h"
#include "vcg_core/engine/eight_steps.h"
#include "vcg_core/engine/step_rates.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Whether a team is faster than its caller alone depends on how far apart the cores are and on what else
/// they do, so it is tried from time to time. What is computed does not depend on it.
class ThreadTiming {
public:
    /// Whether the next batch is for the whole team.
    bool together() const;
    /// The batch has taken so many nanoseconds per signal.
    void took(double nanoseconds);

private:
    int batch_ = 0;
    double alone_ = 0;
    double together_ = 0;
};

/// A batch of Basic Steps. Every signal finds its winner, and every winner and ring its displacement, in the
/// network as it is when the batch begins; the displacements are then summed, for every vertex in the order
/// of the signals. A batch of one is the paper's step.
///
/// Each thread has a slab of its own, a slab of space: it takes the signals there, and it alone moves the
/// vertices there, so that they stay in the cache of its core. What a signal near a border does to vertices
/// of another slab is added by that slab's thread. So slabs, and how many threads there are, do not
/// change what is computed.
class BasicStepBatch {
public:
    static constexpr int kMostSignals = 4096;
    /// Vertices from which on the network is not in the cache anyway.
    static constexpr int kLeastOutOfCache = 16384;

    /// \p threads as in Settings; slabs are cut so that each holds as many of \p typical signals.
    BasicStepBatch(int threads, const std::vector<vcg::Point3f>& typical);

    /// Takes \p count (1 to kMostSignals) steps. O(count) expected.
    void take(const vcg::Point3f* signals, int count, const StepRates& rates, Network& network,
              WinnerSearch& search);

    /// Vertices are given their slabs anew, and whether the team pays is tried anew: to be called when the
    /// network has become another, in size or in order.
    void reconsider() { assigned_ = false; }

    /// Of the last batch, how many signals, and per signal: its winner, and delta of eq 2, with the normal
    /// before and after the whole step.
    int count() const { return count_; }
    VertexId winner(int signal) const { return winners_[static_cast<std::size_t>(signal)]; }
    double delta(int signal) const { return static_cast<double>(deltas_[static_cast<std::size_t>(signal)]); }

    /// As ThreadTeam::run_in_background(), what another thread may do until the next take(); not at all if
    /// this one does all the work.
    template <class Body>
    ThreadTeam::BackgroundTask run_in_background(const Body& body) {
        return slab_count_ > 1 ? team_.run_in_background(body) : ThreadTeam::BackgroundTask();
    }

private:
    /// One of the steps of a part.
    struct Step {
        int signal;
        int slab;
        int index;
    };
    /// The steps of one slab, in the order of their signals. Aligned, for no cache line is to be of two
    /// slabs.
    struct alignas(64) Part {
        EightSteps patches;
        std::vector<int> signals;  ///< which of the batch
        std::vector<VertexId> winners;
        std::vector<float> deltas;
        std::vector<Four> displacements;
        std::vector<int> order;            ///< by valence
        std::vector<std::uint8_t> inside;  ///< 1: moves vertices of this slab only
        std::vector<int> across;           ///< the steps that do not
        std::vector<Step> from_others;     ///< that may move vertices of this slab
        std::vector<WinnerSearch::CellChange> cell_changes;
        int moves = 0;  ///< of vertices, by these steps
    };
    struct Batch {
        const vcg::Point3f* signals;
        int count;
        int slabs;
        const StepRates& rates;
        Network& network;
        WinnerSearch& search;
    };

    /// The winner's displacement, then those of its ring.
    static constexpr int kStride = 1 + Ring::kMaxValence;

    Part& part_of(int slab) { return parts_[static_cast<std::size_t>(slab)]; }
    void make_room(int count);
    int slabs_for(int count, Network& network, WinnerSearch& search);
    void compute(const Batch& batch, int slab);
    void take_signals(const Batch& batch, int slab);
    static void find_winners(const Batch& batch, bool out_of_cache, Part& part);
    static void sort_by_valence(const Network& network, Part& part);
    void step_group(const Batch& batch, int slab, const int* group, int count);
    void hand_over(const Batch& batch);
    void apply(const Batch& batch, int slab);
    void collect(const Batch& batch);

    ThreadTeam team_;
    ThreadTiming pace_;
    AxisPartition partition_;
    bool assigned_ = false;  ///< every vertex has a slab
    int count_ = 0;          ///< of signals of the last batch
    int slab_count_ = 1;     ///< of the last batch
    std::vector<Part> parts_;
    std::vector<VertexId> winners_;
    std::vector<float> deltas_;
};

}  // namespace neuralmesh
