// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// After how many signals the learning splits, collapses, settles and gives up, and what tells that it may
// end.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vcg_core/learning/learner_options.h"

namespace neuralmesh {

/// Signals after which growth that has not reached its goal is forced: there are no more collapses, and
/// vertices no longer need maturity, so that every C_vs signals add a vertex. (Growth stalls if the goal
/// exceeds the number of vertices that can win, for instance with a handful of points.)
inline std::int64_t growth_budget(const LearnerOptions& options) {
    constexpr std::int64_t kBase = 100000;  ///< for small networks, which need more signals per vertex
    const std::int64_t per_vertex =
        4 * std::int64_t{options.signals_per_split} + 2 * std::int64_t{options.min_wins_per_split};
    return per_vertex * options.grow_to + kBase;
}

/// Signals after which growth is cut short. Leaves twice what forced growth needs. The stages of learned
/// topology may take all vertices away, and the numbers of vertices at all stages (TopologyStages) add up to
/// less than three times the goal: forced growth then grows four times as much.
inline std::int64_t signal_bound(const LearnerOptions& options) {
    const std::int64_t times = options.learn_topology ? 4 : 1;
    return growth_budget(options) + 2 * times * options.signals_per_split * options.grow_to;
}

/// Signals of a settling phase of \p per_vertex signals per vertex: at least 60,000 unless \p per_vertex is
/// 0.
inline std::int64_t settling_signals(int per_vertex, int vertices) {
    constexpr std::int64_t kLeast = 60000;
    return per_vertex == 0 ? 0 : std::max(std::int64_t{per_vertex} * vertices, kLeast);
}

/// When the steps of growth are due. All arguments count signals since the start of the learning.
class GrowthSchedule {
public:
    /// Keeps a reference to \p options.
    GrowthSchedule(const LearnerOptions& options, int vertices)
        : options_(options), vertices_at_collapse_(vertices) {}

    /// Growth begins: the budget and the bound count from here.
    void begin(std::int64_t signals) { begin_ = signals; }

    bool split_due(std::int64_t signals) const { return signals % options_.signals_per_split == 0; }

    bool collapse_due(std::int64_t signals) const {
        return signals - last_collapse_ >=
               std::int64_t{vertices_at_collapse_} * options_.signals_per_collapse;
    }
    void collapsed(std::int64_t signals, int vertices) {
        last_collapse_ = signals;
        vertices_at_collapse_ = vertices;
    }
    std::int64_t last_collapse() const { return last_collapse_; }

    bool stalled(std::int64_t signals) const { return signals >= begin_ + growth_budget(options_); }
    bool exhausted(std::int64_t signals) const { return signals >= begin_ + signal_bound(options_); }

private:
    const LearnerOptions& options_;
    std::int64_t begin_ = 0;
    std::int64_t last_collapse_ = 0;
    int vertices_at_collapse_;
};

/// Tells when a network grows no more though splits are due. The others are refused for the noise, or
/// collapses take their vertices away: at noisy places vertices are split, win little and go, over and over.
class Saturation {
public:
    /// \param vertices after the collapses that end a period \param due splits so far, done or refused
    /// \return whether the network has grown by a tenth or less of the splits that were due in each of the
    /// last periods.
    bool reached(int vertices, std::int64_t due) {
        constexpr std::int64_t kLeastGrowth = 10;  // splits that are due for a vertex more
        // One is not enough: at first the vertices of the start mesh go that are not needed where they are.
        constexpr int kPeriods = 4;
        const bool grows = kLeastGrowth * (vertices - vertices_) > due - due_;
        vertices_ = vertices;
        due_ = due;
        periods_ = grows ? 0 : periods_ + 1;
        return periods_ >= kPeriods;
    }

private:
    int vertices_ = 0;  ///< at the end of the last period
    std::int64_t due_ = 0;
    int periods_ = 0;  ///< without growth
};

/// Root mean square angle by which a Basic Step turns the winner's normal, over about the last ten signals
/// per vertex.
///
/// It replaces the Mean(n_c) of eq 8, which cannot tell when to stop: its n_delta are normalised (see eq 3),
/// so it stays near 1 for the counters of eq 6, and near 20 / vertices for those of eq 4, however far the
/// mesh has converged. The deltas before normalisation do fall; degrees() is their mean, converted to an
/// angle. In the dialog the bound is called stop_below_mean_counter.
///
class NormalTurn {
public:
    /// The memory is a compromise. A few vertices at the sharpest places have most of the sum, so a mean over
    /// few signals, such as C_delta = 1000, falls below a bound by chance long before the mesh does. A longer
    /// memory lags behind the growth, which doubles the vertices in 100 signals per vertex.
    static constexpr int kSignalsPerVertex = 10;

    /// Adds the \p delta of a signal (see eq 2) that a mesh of \p vertices vertices has learned. O(1).
    void add(double delta, int vertices) {
        ++signals_;
        const double memory = std::max(kLeastMemory, static_cast<double>(kSignalsPerVertex) * vertices);
        mean_ += (delta - mean_) / std::min(signals_, memory);
    }

    /// 0 before the first signal.
    double degrees() const {
        // delta = 1 - cos(angle), which for small angles is angle^2 / 2.
        return kDegreesPerRadian * std::sqrt(2 * mean_);
    }

private:
    static constexpr double kLeastMemory = 1000;  ///< signals, for small meshes
    static constexpr double kDegreesPerRadian = 57.29577951308232;

    double signals_ = 0;
    double mean_ = 0;
};

}  // namespace neuralmesh
