// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Many Basic Steps (the paper's section 2) from one state of the network: computed in SIMD lanes and threads,
// then added up in the order of their signals.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/engine/slab_schedule.h"
#include "vcg_core/engine/slab_steps.h"
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

    /// The arguments are those of SlabSchedule.
    BasicStepBatch(int threads, const std::vector<vcg::Point3f>& typical_signals)
        : schedule_(threads, typical_signals), slabs_(static_cast<std::size_t>(schedule_.max_slabs())) {}

    /// Takes \p count steps, 1 to kMostSignals. \return their results in the order of the signals, valid
    /// until the next call. O(count) expected.
    const std::vector<StepResult>& take(const vcg::Point3f* signals, int count, const StepRates& rates,
                                        Network& network, WinnerSearch& search);

    /// Call after the network was renumbered or has grown: reassigns slabs and repeats the thread timing.
    void reassign_slabs() { schedule_.reassign(); }

    /// Starts \p body() on another thread; the destructor of the result waits for its end. Destroy the result
    /// before the next take(). Does nothing if the last batch ran on one thread. See
    /// ThreadTeam::run_in_background().
    template <class Body>
    ThreadTeam::BackgroundTask run_in_background(const Body& body) {
        return schedule_.run_in_background(body);
    }

    /// The threads that compute the batches. Not to be used while anything runs in the background.
    ThreadTeam& team() { return schedule_.team(); }

private:
    /// Step number index of a slab, which moves vertices of other slabs, too.
    struct BorderStep {
        int signal;
        int slab;
        int index;
    };
    /// Aligned as SlabSteps.
    struct alignas(64) Slab {
        SlabSteps steps;
        std::vector<BorderStep> border_steps;  ///< of other slabs, in the order of their signals
        std::vector<WinnerSearch::CellChange> cell_changes;
    };

    Slab& slab_at(int i) { return slabs_[static_cast<std::size_t>(i)]; }
    void exchange_border_steps();
    void apply(int slab, const Network& network, WinnerSearch& search);
    void collect(WinnerSearch& search);

    SlabSchedule schedule_;
    std::vector<Slab> slabs_;
    std::vector<StepResult> results_;
};

}  // namespace neuralmesh
