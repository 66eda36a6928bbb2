// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Several Basic Steps (the paper's section 2) from one state of the network: computed side by side, in lanes
// and threads, and then added to the network in the order of their signals.
#pragma once

#include <vector>

#include "network.h"
#include "patches.h"
#include "team.h"
#include "winner_search.h"

namespace neuralmesh {

/// The constants of a Basic Step.
struct StepRates {
    float learning;   ///< alpha_w, eq 1
    float smoothing;  ///< alpha_L
    int sweeps;       ///< C_L
};

/// Whether a team is faster than its caller alone depends on how far apart the cores are and on what else
/// they do, so it is tried from time to time. What is computed does not depend on it.
class Pace {
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
/// network as it is when the batch begins; the displacements are then summed. A batch of one is the paper's
/// step. Results do not depend on how many threads compute them.
class BasicSteps {
public:
    static constexpr int kMostSignals = 4096;
    /// Vertices from which on the network is not in the cache anyway.
    static constexpr int kLeastOutOfCache = 16384;

    /// \p threads as in Settings.
    explicit BasicSteps(int threads);

    /// Takes \p count (1 to kMostSignals) steps. O(count) expected.
    void take(const vcg::Point3f* signals, int count, const StepRates& rates, Network& network,
              WinnerSearch& search);

    /// Of the last batch, per signal: its winner, and delta of eq 2, with the normal before and after the
    /// whole step.
    VertexId winner(int signal) const { return winners_[static_cast<std::size_t>(signal)]; }
    double delta(int signal) const { return static_cast<double>(deltas_[static_cast<std::size_t>(signal)]); }

private:
    /// What a thread needs for itself.
    struct Scratch {
        Patches patches;
        std::vector<int> order;
    };

    void compute(const vcg::Point3f* signals, int begin, int end, const StepRates& rates,
                 const Network& network, const WinnerSearch& search, Scratch& scratch);
    void sort_by_valence(int begin, int end, const Network& network, std::vector<int>& order) const;
    void step_group(const vcg::Point3f* signals, const int* group, int count, const StepRates& rates,
                    const Network& network, Patches& patches);
    void apply(int count, const Network& network, WinnerSearch& search) const;

    /// The winner's displacement, then those of its ring.
    static constexpr int kStride = 1 + Ring::kMaxValence;

    Team team_;
    Pace pace_;
    std::vector<Scratch> scratch_;  ///< one per member of the team
    std::vector<VertexId> winners_;
    std::vector<float> deltas_;
    std::vector<Four> displacements_;
};

}  // namespace neuralmesh
