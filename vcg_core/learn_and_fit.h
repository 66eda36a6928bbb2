// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Learning and the fit after it, with the number of vertices that the network grows to in between.
#pragma once

#include "vcg_core/base/progress.h"
#include "vcg_core/learning_task.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/neural_mesh.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// Fractions of a whole run, for its progress: prepare() ends at the first, learning at the second.
constexpr double kPrepared = 0.1;
constexpr double kLearned = 0.8;

struct LearnedNetwork {
    Network network;            ///< after the fit, oriented outward
    PerVertex<float> counters;  ///< what settings.feature_measure names
    StopReason stop_reason = StopReason::target_reached;
    bool forced = false;  ///< growth had stalled, see growth_budget()
    /// Of all learning, including growth whose result was discarded.
    long long signals = 0;
    long long splits = 0;
    long long collapses = 0;
};

/// Learns the points of \p task and fits the network to them if settings.fit_to_points.
///
/// The fit knows better than the learning where vertices are needed. So the network first grows to more than
/// settings.target_vertices (up to four times as many, the surplus falling to none at 5,000), and the fit
/// removes those whose loss costs least. If that growth stalls, its result is discarded, and a second one
/// stops at settings.target_vertices. If the caller asked to stop, the network has at most that many.
/// Fractions of \p progress run from kPrepared to 1.
LearnedNetwork learn_and_fit(const LearningTask& task, const Settings& settings, MonotoneProgress& progress);

}  // namespace neuralmesh
