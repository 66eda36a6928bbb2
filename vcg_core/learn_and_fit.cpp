// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learn_and_fit.h"

#include <algorithm>
#include <cstdint>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/random.h"
#include "vcg_core/fit/fit.h"
#include "vcg_core/learning/learner.h"
#include "vcg_core/mesh/simplify.h"
#include "vcg_core/thickening.h"

namespace neuralmesh {

namespace {

/// The fit inserts up to this many times the vertices that it finds. A number that is a slip of the pen, 20
/// million from 500 points, would take all memory at once; learning takes its time and can be cancelled.
constexpr int kMostPerCarried = 64;

std::size_t carried_by_points(const LearningTask& task) {
    const std::size_t points = task.target().positions().size();
    return task.noise_by_place ? task.noise_by_place->carried_by(points) : points / kPointsPerCarried;
}

/// Whether the fit inserts the vertices that the points do not carry.
bool fills_up(const LearningTask& task, const Settings& settings) {
    constexpr std::size_t kFewestToFill = 256;
    return settings.redistributes_vertices() && task.encloses_space && !task.target().has_faces() &&
           task.target().positions().size() >= kFewestToFill && !skips("refine");
}

/// The vertices that learning and fit place by the points; the fit inserts the others. All, unless the cloud
/// is no sheet, the fit may redistribute vertices and only their number ends growth, or where there are too
/// few points for a fit.
int carried_vertices(const LearningTask& task, const Settings& settings) {
    const int wanted = settings.target_vertices;
    if (!fills_up(task, settings)) return wanted;
    const std::size_t carried = carried_by_points(task);
    if (static_cast<std::size_t>(wanted) / kMostPerCarried > carried) return wanted;
    const std::size_t placed = std::max(carried, static_cast<std::size_t>(task.network.vertex_count()));
    return static_cast<int>(std::min(placed, static_cast<std::size_t>(wanted)));
}

bool is_closed(const LearningTask& task) { return task.network.boundary_loop_count() == 0; }

/// Whether the noise is small beside the edges. Then the network learns many more vertices than are asked
/// for, and the fit keeps those that matter. With more noise large meshes would follow it with them; small
/// ones may learn more, see reduces_by_volume(). Not with boundaries: open clouds take longer than closed
/// ones as it is. Cut models of 2,000 vertices would have .93 of the error. Chosen by
/// tests/experiments/accuracy/accuracy_table.py and open_table.py.
bool is_calm(const LearningTask& task) {
    constexpr double kCalmNoise = 0.05;  // in edges
    return task.noise < kCalmNoise && is_closed(task);
}

/// What the network grows beyond \p final_vertices if the fit reduces by volume. Calm: with 2,500, 500
/// vertices would have 1.1 times the error, with 5,000, 2,000 would; a preview of 1,000 has to come at once.
/// With noise of .6 % of the diagonal and 10,000, 5,000 vertices would have 1.1 times the error.
int surplus_for_volume(const LearningTask& task, int final_vertices) {
    constexpr int kLeast = 4000, kMost = 10000;
    if (!is_calm(task)) return kLeast;
    return std::min(std::max(8 * final_vertices - 6000, kLeast), kMost);
}

/// Whether the fit reduces by volume. Not with very many outliers, because some of them are left beside the
/// surface; up to a tenth of the points, the most measured, was fine. For few vertices there must be many
/// points: with 4 for each learned vertex, sharp edges are doubled and corners cut off, and small faces stay
/// as long as there is anything flat to collapse. 5 of 16 cubes of 400 and 600 vertices then have more than
/// 12 crease lines, and 2 by costs; from 100,000 points none has. With noise, 5,000 vertices gain nothing in
/// 1.4 times the time, and 1,000 may have twice the error where it is 2 % of the diagonal.
bool reduces_by_volume(const LearningTask& task, int final_vertices) {
    constexpr double kMostOutliers = 0.2, kMostNoise = 0.15;
    constexpr int kFew = 1000, kFewNoisy = 3000, kPointsPerLearned = 10;
    const auto points = static_cast<double>(task.target().positions().size());
    const int learned = final_vertices + surplus_for_volume(task, final_vertices);
    if (!is_closed(task) || task.outliers >= kMostOutliers * points || skips("volume_reduction"))
        return false;
    if (is_calm(task) && final_vertices >= kFew) return true;
    return task.noise < kMostNoise && final_vertices < kFewNoisy && points >= kPointsPerLearned * learned;
}

/// How many vertices the network learns and keeps, and how the fit removes the others; see learn_and_fit().
struct Plan {
    int carried = 0;         ///< vertices that learning and fit place by the points
    int grow_to = 0;         ///< at least
    bool calm = false;       ///< see is_calm()
    bool by_volume = false;  ///< see reduces_by_volume()

    bool has_surplus() const { return grow_to > carried; }
};

/// Number of vertices that the network grows to. There is a surplus only if the fit may redistribute vertices
/// and only the number of vertices ends growth. With too few points per vertex, learning cannot place the
/// vertices. Chosen by tests/experiments/accuracy/accuracy_table.py.
int vertices_to_grow(const LearningTask& task, const Settings& settings, const Plan& plan) {
    const int start = task.network.vertex_count(), carried = plan.carried;
    if (!settings.redistributes_vertices() || !task.encloses_space) return std::max(carried, start);
    // Growth removes the vertices that the landing leaves without signals, far off.
    const int least = start > carried ? start + start / 4 : start;
    int surplus = surplus_vertices(settings, carried);
    if (plan.by_volume) surplus = std::max(surplus, surplus_for_volume(task, carried));
    const int grow_to = std::max(least, carried + surplus);
    if (task.target().has_faces()) return grow_to;
    const std::size_t points_per_vertex = plan.by_volume || plan.calm ? 3 : 10;
    const std::size_t supported = task.target().positions().size() / points_per_vertex;
    return std::max(
        {carried, least, static_cast<int>(std::min(supported, static_cast<std::size_t>(grow_to)))});
}

Plan plan_for(const LearningTask& task, const Settings& settings) {
    Plan plan;
    plan.carried = carried_vertices(task, settings);
    plan.calm = is_calm(task);
    plan.by_volume = reduces_by_volume(task, plan.carried);
    plan.grow_to = vertices_to_grow(task, settings, plan);
    return plan;
}

/// Whether half the signals do for growth: most of the vertices will go, and the fit places them. Of 2,000
/// vertices and more accuracy is wanted: they would have 1.02 times the error.
bool learns_briefly(const Plan& plan) {
    constexpr int kPreview = 2000;
    return plan.by_volume && plan.has_surplus() && plan.carried < kPreview && !skips("brief_learning");
}

/// Whether a network that learns for long follows the noise of the points. With half the signals the error is
/// .97 with 10,000 and 20,000 vertices at noise of .3 % of the diagonal (.17 and .23 edges), and with 100,000
/// at .1 % (.16 edges). With 20,000 at .1 % (.13 edges) it would be 1.02.
bool follows_noise(const LearningTask& task, const Settings& settings) {
    constexpr double kNoisy = 0.14;  // in edges
    return settings.redistributes_vertices() && is_closed(task) && task.encloses_space &&
           !task.target().has_faces() && task.noise >= kNoisy && !skips("noisy_learning");
}

LearnerOptions learner_options(const LearningTask& task, const Settings& settings, const Plan& plan) {
    LearnerOptions options = learner_options_from(settings);
    options.grow_to = plan.grow_to;
    if (task.noise_by_place && fills_up(task, settings)) options.noise = &*task.noise_by_place;
    if (learns_briefly(plan) || follows_noise(task, settings))
        options.signals_per_split = std::max(1, options.signals_per_split / 2);
    // As many signals as for those that stay settle them well enough; half as many where most of them stay:
    // 50,000 and 100,000 vertices then have .99 and .98 of the error.
    if (plan.has_surplus() && settings.redistributes_vertices() && (plan.calm || plan.by_volume) &&
        !skips("settling_surplus"))
        options.settling_signals_per_vertex =
            static_cast<int>(static_cast<std::int64_t>(options.settling_signals_per_vertex) * plan.carried /
                             std::max(plan.grow_to, 2 * plan.carried));
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
    options.noise = task.noise_by_place ? &*task.noise_by_place : nullptr;
    options.reduce_to = plan.carried;
    options.by_volume = plan.by_volume && network.vertex_count() > plan.carried;
    options.learned_briefly = learns_briefly(plan);
    options.calm = plan.calm || options.by_volume;
    // Growth by the noise of each place may end early.
    const bool refines =
        plan.carried < settings.target_vertices || (task.noise_by_place && fills_up(task, settings));
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

}  // namespace

LearnedNetwork learn_and_fit(const LearningTask& task, const Settings& settings, MonotoneProgress& progress) {
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
