// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learn_and_fit.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/random.h"
#include "vcg_core/fit/fit.h"
#include "vcg_core/fit/redistribute.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/simplify.h"

namespace neuralmesh {

namespace {

/// Noise, averaged over the points of a vertex, in edges, up to which points say where the vertex is. Bunny,
/// fandisk and koala with noise of .3 % of the diagonal and 50,000 points have .11 to .12 with 10,000
/// vertices, whose error is that of 5,000 or less. With 20,000 they have .22 to .23, and with .6 % and 10,000
/// .19 to .21: with all of them placed by the points the error was up to twice that of 5,000.
constexpr double kMostAveraged = 0.12;

/// \param vertices those that task.noise is of
std::size_t carried_by_points(const LearningTask& task, int vertices) {
    const std::size_t points = task.target().positions().size();
    if (task.noise_by_place) return task.noise_by_place->carried_by(points);
    // Points per vertex fall with their number, and edges with its square root.
    const double by_noise =
        kMostAveraged * std::sqrt(static_cast<double>(points) * vertices) / std::max(task.noise, 1e-9);
    return std::min(points / kPointsPerCarried, static_cast<std::size_t>(by_noise));
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

FitOptions fit_options(const LearningTask& task, const Settings& settings, const Plan& plan) {
    FitOptions options;
    options.expect_strays = task.outliers > 0;
    options.noise = task.noise_by_place ? &*task.noise_by_place : nullptr;
    options.reduce_to = plan.carried;
    options.by_volume = plan.by_volume;
    // Growth by the noise of each place may end early.
    const bool refines = plan.carried < settings.target_vertices || (task.noise_by_place && plan.fills_up);
    options.refine_to = refines ? settings.target_vertices : 0;
    // The signal counter asks for the density of the cloud, which redistribution would undo. On a sheet the
    // error is largest at the rim, and vertices inserted there stick out.
    options.redistribute = settings.utility_counter == kNormalVariation && task.encloses_space;
    return options;
}

void fit(Network& network, const LearningTask& task, const FitOptions& options, const Settings& settings,
         Progress& progress) {
    fit_to_points(network, task.target(), options, settings.threads,
                  stream_seed(settings.random_seed, Stream::fit), progress);
}

/// Before the fit. \p before: the figures of earlier learners.
LearnedNetwork learned_by(const Learner& learner, StopReason reason, const LearnedNetwork& before) {
    LearnedNetwork result;
    result.stop_reason = reason;
    result.network = learner.network();
    result.forced = learner.forced();
    result.topology_changes = before.topology_changes + learner.topology_changes();
    result.signals = before.signals + learner.signals();
    result.splits = before.splits + learner.splits();
    result.collapses = before.collapses + learner.collapses();
    return result;
}

/// The fit stops where the topology leaves only collapses that spoil the shape.
void finish(Network& network, int vertices) {
    if (network.vertex_count() > vertices) simplify(network, vertices);
    network.orient_outward();
}

PerVertex<float> taken_over(const PerVertex<float>& values, const PerVertex<VertexId>& sources) {
    if (values.empty()) return values;
    PerVertex<float> result(sources.size(), 0);
    for (VertexId v = 0; v < sources.size(); ++v)
        if (sources[v] >= 0) result[v] = values[sources[v]];
    return result;
}

/// Learns only what the counters of the network are, which stays.
LearnedNetwork observed(const LearningTask& task, const Settings& settings, Progress& progress) {
    // In the order into which learning would bring it, so that ids stay the same.
    Network network = task.network;
    network.renumber(morton_order(network));
    Learner learner(task.target(), learner_options_from(settings), network);
    const bool finished = learner.settle(settings.settling_signals_per_vertex, progress);
    learner.move_to(network.positions());
    LearnedNetwork result =
        learned_by(learner, finished ? StopReason::target_reached : StopReason::cancelled, {});
    result.measures = measures_of(learner, learner.crease_measure(), result.network, {}, settings);
    result.carried = static_cast<int>(task.given.positions().size());
    return result;
}

}  // namespace

Learning::Learning(const LearningTask& task, const Settings& settings)
    : task_(task),
      settings_(settings),
      team_(thread_count(settings.threads)),
      thickening_(task, team_),
      thicker_(thickening_.thicker(task, team_)) {}

Settings Learning::settings_for(int vertices) const {
    Settings settings = settings_;
    settings.target_vertices = vertices;
    return settings;
}

Plan Learning::plan_for(const Settings& settings) const {
    Circumstances given;
    given.vertices = settings.target_vertices;
    given.start_vertices = task_.network.vertex_count();
    given.points = task_.target().positions().size();
    given.exact = task_.target().is_exact();
    // Edges are as long as the square root of the area of a vertex.
    given.noise =
        task_.noise * std::sqrt(static_cast<double>(settings.target_vertices) / settings_.target_vertices);
    given.outliers = static_cast<double>(task_.outliers) / static_cast<double>(given.points);
    given.carried_by_points = carried_by_points(task_, settings_.target_vertices);
    given.closed = task_.network.boundary_loop_count() == 0;
    given.encloses_space = task_.encloses_space;
    given.redistributes = settings.redistributes_vertices();
    return neuralmesh::plan_for(given);
}

StopReason Learning::learn(const Settings& settings, const Plan& plan, Progress& progress) {
    // Without the fit nothing takes vertices away again.
    const bool goes_on = learner_ && settings.redistributes_vertices();
    if (goes_on && learner_->network().vertex_count() >= plan.grow_to) return StopReason::target_reached;
    if (goes_on) before_ = learned_by(*learner_, StopReason::target_reached, before_);
    const Network start = goes_on ? before_.network : task_.network;
    learner_.emplace(thicker_ ? *thicker_ : task_.target(), learner_options(task_, settings, plan), start);
    return learner_->run(goes_on ? 0 : task_.landing_signals, progress);
}

LearnedNetwork Learning::with(int vertices, MonotoneProgress& progress) {
    const Settings settings = settings_for(vertices);
    if (task_.is_known) return observed(task_, settings, progress);
    const Plan plan = plan_for(settings);
    PartOf learning(progress, kPrepared, settings.fit_to_points ? kLearned : 1);
    PartOf fitting(progress, kLearned, 1);
    const StopReason reason = learn(settings, plan, learning);
    LearnedNetwork result = learned_by(*learner_, reason, before_);
    thickening_.take_back(result.network, team_);
    const VertexPlaces learned(result.network);
    const bool fits = settings.fit_to_points && !progress.stopped();
    if (fits) fit(result.network, task_, fit_options(task_, settings, plan), settings, fitting);
    if (progress.stopped()) result.stop_reason = StopReason::cancelled;
    finish(result.network, vertices);
    result.measures =
        measures_of(*learner_, learner_->crease_measure(), result.network,
                    fits ? nearest_vertices(learned, result.network) : PerVertex<VertexId>(), settings);
    if (plan.carried < vertices)
        result.carried = static_cast<int>(carried_by_points(task_, settings_.target_vertices));
    return result;
}

LearnedNetwork Learning::reduced(const LearnedNetwork& finer, int vertices,
                                 MonotoneProgress& progress) const {
    LearnedNetwork result = finer;
    if (task_.is_known) return result;
    const Settings settings = settings_for(vertices);
    FitOptions options = fit_options(task_, settings, plan_for(settings));
    options.fitted_before = true;
    fit(result.network, task_, options, settings, progress);
    if (progress.stopped()) result.stop_reason = StopReason::cancelled;
    finish(result.network, vertices);
    const PerVertex<VertexId> sources = nearest_vertices(VertexPlaces(finer.network), result.network);
    result.measures.normal_counters = taken_over(finer.measures.normal_counters, sources);
    result.measures.creases = taken_over(finer.measures.creases, sources);
    return result;
}

LearnerOptions learner_options_from(const Settings& settings) {
    LearnerOptions options;
    static_cast<LearningConstants&>(options) = settings;
    options.stop_below_turn = settings.stop_below_mean_counter;
    options.grow_to = settings.target_vertices;
    options.learn_topology = settings.learn_topology;
    options.observe_creases = settings.uses(kCreaseMeasure);
    return options;
}

}  // namespace neuralmesh
