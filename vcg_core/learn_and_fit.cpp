// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learn_and_fit.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/random.h"
#include "vcg_core/fit/fit.h"
#include "vcg_core/learning/learner.h"
#include "vcg_core/mesh/simplify.h"
#include "vcg_core/mesh/vertex_order.h"
#include "vcg_core/plan.h"
#include "vcg_core/thickening.h"

namespace neuralmesh {

namespace {

std::size_t carried_by_points(const LearningTask& task) {
    const std::size_t points = task.target().positions().size();
    return task.noise_by_place ? task.noise_by_place->carried_by(points) : points / kPointsPerCarried;
}

Plan plan_for(const LearningTask& task, const Settings& settings) {
    Circumstances given;
    given.vertices = settings.target_vertices;
    given.start_vertices = task.network.vertex_count();
    given.points = task.target().positions().size();
    given.exact = task.target().is_exact();
    given.noise = task.noise;
    given.outliers = static_cast<double>(task.outliers) / static_cast<double>(given.points);
    given.carried_by_points = carried_by_points(task);
    given.closed = task.network.boundary_loop_count() == 0;
    given.encloses_space = task.encloses_space;
    given.redistributes = settings.redistributes_vertices();
    return plan_for(given);
}

int share_of(int number, double share) { return std::max(1, static_cast<int>(std::lround(share * number))); }

LearnerOptions learner_options(const LearningTask& task, const Settings& settings, const Plan& plan) {
    LearnerOptions options = learner_options_from(settings);
    options.grow_to = plan.grow_to;
    if (task.noise_by_place && plan.fills_up) options.noise = &*task.noise_by_place;
    options.signals_per_split = share_of(options.signals_per_split, plan.growth_share);
    if (options.settling_signals_per_vertex > 0)
        options.settling_signals_per_vertex =
            share_of(options.settling_signals_per_vertex, plan.settling_share);
    // Each layer of a sheet wins the signals of both by turns: that says nothing of membranes. The topology
    // of a given mesh is what somebody asked for.
    options.learn_topology =
        options.learn_topology && task.encloses_space && settings.start_mesh != kGivenMesh;
    options.topology_rules = task.topology_rules;
    // The layers of a sheet fold into each other while they learn. Their area vectors cancel, and smoothing
    // at right angles to what is left of them throws vertices off the sheet, where they win no signal.
    if (!task.encloses_space) options.smoothing_steps = 0;
    return options;
}

FitReport fit(Network& network, const LearningTask& task, const Settings& settings, const Plan& plan,
              Progress& progress) {
    FitOptions options;
    options.expect_strays = task.outliers > 0;
    options.expect_layers = plan.expects_layers;
    options.noise = task.noise_by_place ? &*task.noise_by_place : nullptr;
    options.reduce_to = plan.carried;
    options.by_volume = options.precise = plan.by_volume;
    // Growth by the noise of each place may end early.
    const bool refines = plan.carried < settings.target_vertices || (task.noise_by_place && plan.fills_up);
    options.refine_to = refines ? settings.target_vertices : 0;
    // The signal counter asks for the density of the cloud, which redistribution would undo. On a sheet the
    // error is largest at the rim, and vertices inserted there stick out.
    options.redistribute = settings.utility_counter == kNormalVariation && task.encloses_space;
    return fit_to_points(network, task.target(), options, settings.threads,
                         stream_seed(settings.random_seed, Stream::fit), progress);
}

/// Before the fit.
LearnedNetwork learned_by(const Learner& learner, StopReason reason) {
    LearnedNetwork result;
    result.stop_reason = reason;
    result.network = learner.network();
    result.forced = learner.forced();
    result.topology_changes = learner.topology_changes();
    result.signals = learner.signals();
    result.splits = learner.splits();
    result.collapses = learner.collapses();
    return result;
}

/// Learns only what the counters of the network are, which stays.
LearnedNetwork observed(const LearningTask& task, const Settings& settings, Progress& progress) {
    // In the order into which learning would bring it, so that ids stay the same.
    Network network = task.network;
    network.renumber(morton_order(network));
    Learner learner(task.target(), learner_options_from(settings), network);
    const bool finished = learner.settle(settings.settling_signals_per_vertex, progress);
    PerVertex<vcg::Point3f> places;
    for (const VertexId v : network.vertices()) places.push_back(network.position(v));
    learner.move_to(places);
    LearnedNetwork result =
        learned_by(learner, finished ? StopReason::target_reached : StopReason::cancelled);
    result.measures = measures_of(learner, learner.crease_measure(), result.network, {}, settings);
    result.carried = static_cast<int>(task.given.positions().size());
    return result;
}

}  // namespace

LearnedNetwork learn_and_fit(const LearningTask& task, const Settings& settings, MonotoneProgress& progress) {
    if (task.is_known) return observed(task, settings, progress);
    const Plan plan = plan_for(task, settings);
    PartOf learning(progress, kPrepared, settings.fit_to_points ? kLearned : 1);
    PartOf fitting(progress, kLearned, 1);
    const Thickening thickening(task);
    ThreadTeam team(thread_count(settings.threads));
    const std::optional<TargetSpace> thicker = thickening.thicker(task, team);
    Learner learner(thicker ? *thicker : task.target(), learner_options(task, settings, plan), task.network);
    const StopReason reason = learner.run(task.landing_signals, learning);
    LearnedNetwork result = learned_by(learner, reason);
    thickening.take_back(result.network, team);
    FitReport report;
    if (settings.fit_to_points && !progress.stopped())
        report = fit(result.network, task, settings, plan, fitting);
    if (progress.stopped()) result.stop_reason = StopReason::cancelled;
    // The fit stops where the topology leaves only collapses that spoil the shape.
    if (result.network.vertex_count() > settings.target_vertices)
        simplify(result.network, settings.target_vertices);
    result.network.orient_outward();
    const bool moved = report.improved || report.inserted > 0;
    // If the rounds of the fit were discarded, no vertex has moved to the place of another.
    result.measures = measures_of(learner, learner.crease_measure(), result.network,
                                  moved ? report.sources : PerVertex<VertexId>(), settings);
    if (plan.carried < settings.target_vertices) result.carried = static_cast<int>(carried_by_points(task));
    return result;
}

LearnerOptions learner_options_from(const Settings& settings) {
    LearnerOptions options;
    options.learning_rate = settings.learning_rate;
    options.smoothing_rate = settings.smoothing_rate;
    options.smoothing_steps = settings.smoothing_steps;
    options.signals_per_split = settings.signals_per_split;
    options.signals_per_collapse = settings.signals_per_collapse;
    options.counter_decay = settings.counter_decay;
    options.feature_decay = settings.feature_decay;
    options.normalization_window = settings.normalization_window;
    options.stop_below_turn = settings.stop_below_mean_counter;
    options.utility_increment =
        settings.utility_counter == kNormalVariation ? UtilityIncrement::n_delta : UtilityIncrement::one;
    options.grow_to = settings.target_vertices;
    options.learn_topology = settings.learn_topology;
    options.min_wins_per_split = settings.min_wins_per_split;
    options.settling_signals_per_vertex = settings.settling_signals_per_vertex;
    options.observe_creases = settings.uses(kCreaseMeasure);
    options.random_seed = settings.random_seed;
    options.threads = settings.threads;
    return options;
}

}  // namespace neuralmesh
