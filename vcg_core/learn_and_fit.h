// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Learning, then the fit. Decides how many vertices the network grows to before the fit reduces it.
#pragma once

#include <optional>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/feature_measures.h"
#include "vcg_core/learning/learner.h"
#include "vcg_core/learning/learner_options.h"
#include "vcg_core/learning_task.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/plan.h"
#include "vcg_core/result.h"
#include "vcg_core/settings.h"
#include "vcg_core/thickening.h"

namespace neuralmesh {

/// Fractions of a whole run, for its progress: prepare() ends at the first, learning at the second.
constexpr double kPrepared = 0.1;
constexpr double kLearned = 0.8;

/// A network after learning and fit, and what the report says of it.
struct LearnedNetwork {
    Network network;  ///< after the fit, oriented outward
    FeatureMeasures measures;
    StopReason stop_reason = StopReason::target_reached;
    bool forced = false;  ///< growth stalled and was forced, see growth_budget()
    /// Vertices that the points carry, if these are less than were asked for; else 0.
    int carried = 0;
    int topology_changes = 0;  ///< with settings.learn_topology: places where membranes were given up
    long long signals = 0;
    long long splits = 0;
    long long collapses = 0;
};

/// Learns the points of a task and fits the network to them if settings.fit_to_points, for one number of
/// vertices after another.
///
/// The fit judges better than the learning where vertices are needed. So the network first grows to more
/// vertices than are asked for, with fewer signals for each, and the fit reduces it (plan.h).
///
/// Where there are fewer than two points per vertex asked for, the network learns as many vertices as half
/// the points. Then the fit inserts the others, which make the mesh smoother between the points.
class Learning {
public:
    /// Keeps a reference to \p task, which prepare() made with \p settings.
    Learning(const LearningTask& task, const Settings& settings);

    /// The network of the last call grows on, if it has too few vertices for as many as \p vertices. If \p
    /// progress asks to stop, the result has at most \p vertices. Fractions of \p progress run from kPrepared
    /// to 1. Cost: see growth_limits.h and fit.h.
    LearnedNetwork with(int vertices, MonotoneProgress& progress);
    /// \p finer, a result, reduced to \p vertices and fitted again. Fractions of \p progress run from 0 to 1.
    /// Cost: see fit.h. \pre settings.redistributes_vertices()
    LearnedNetwork reduced(const LearnedNetwork& finer, int vertices, MonotoneProgress& progress) const;

private:
    Settings settings_for(int vertices) const;
    Plan plan_for(const Settings& settings) const;
    /// \return why learning ended
    StopReason learn(const Settings& settings, const Plan& plan, Progress& progress);

    const LearningTask& task_;
    const Settings settings_;
    ThreadTeam team_;
    const Thickening thickening_;
    std::optional<TargetSpace> thicker_;
    std::optional<Learner> learner_;
    LearnedNetwork before_;  ///< figures of the learners before
};

/// The learner's part of \p settings. It grows to settings.target_vertices.
LearnerOptions learner_options_from(const Settings& settings);

}  // namespace neuralmesh
