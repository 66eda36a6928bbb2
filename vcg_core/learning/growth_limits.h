// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// After how many signals settling and growth end, where the paper has no bound.
#pragma once

#include <algorithm>
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

}  // namespace neuralmesh
