// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh_counters.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "vcg_core/feature_measures.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learning/learner.h"
#include "vcg_core/learning_task.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/start/given_start.h"

namespace neuralmesh {

namespace {

/// The memory of the counters of eq 6. Longer rounds drift: on fandisk, collapsed by quadrics to 5,000
/// vertices, creases are found with an F1 of .61 if there is one round of 60, .68 with three of 20, .69 with
/// six of 10.
constexpr int kSignalsPerRound = 20;

/// The network of a given mesh. It is in the order into which learning would bring it (memory_order.h), so
/// that ids stay the same.
struct WorkingCopy {
    Network network;
    PerVertex<int> sources;  ///< per vertex its index in the given mesh
};

WorkingCopy copy_of(const GivenStart& given) {
    WorkingCopy copy{Network(given.positions, given.faces), {}};
    const std::vector<VertexId> order = morton_order(copy.network);
    copy.network.renumber(order);
    for (const VertexId v : order) copy.sources.push_back(given.sources[static_cast<std::size_t>(v)]);
    return copy;
}

/// Learns in rounds that begin at the places of \p given. \return the moments of all rounds
CreaseMeasure learn_around(const Network& given, int signals_per_vertex, Learner& learner,
                           MonotoneProgress& progress) {
    const PerVertex<vcg::Point3f> places = given.positions();
    const std::int64_t signals = settling_signals(signals_per_vertex, given.vertex_count());
    const std::int64_t per_round = std::int64_t{kSignalsPerRound} * given.vertex_count();
    CreaseMeasure moments;
    while (learner.signals() < signals && !progress.stopped()) {
        const auto whole = static_cast<double>(signals);
        const std::int64_t count = std::min(per_round, signals - learner.signals());
        const auto begin = static_cast<double>(learner.signals());
        PartOf round(progress, begin / whole, (begin + static_cast<double>(count)) / whole);
        learner.move_to(places);
        learner.learn_at_rest(count, round);
        moments.add(learner.crease_measure());
    }
    return moments;
}

/// The values of \p copy in the order of the given mesh's \p count vertices. A vertex of which the copy has
/// several gets the greatest.
std::vector<float> in_given_order(const PerVertex<float>& values, const WorkingCopy& copy,
                                  std::size_t count) {
    std::vector<float> result(count, 0.0F);
    for (const VertexId v : copy.network.vertices()) {
        float& value = result[static_cast<std::size_t>(copy.sources[v])];
        value = std::max(value, values[v]);
    }
    return result;
}

/// Fills counters, features and their figures. Vertices that no face uses do not count.
void write_measures(const FeatureMeasures& measures, const WorkingCopy& copy, const Settings& settings,
                    MeshCounters& result) {
    std::vector<int> used(copy.sources.begin(), copy.sources.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const auto of_used = [&](int measure) {
        const auto all = in_given_order(measures.values(measure), copy, result.counters.size());
        std::vector<float> values;
        for (const int i : used) values.push_back(all[static_cast<std::size_t>(i)]);
        return values;
    };
    const std::vector<float> counters = of_used(settings.feature_measure);
    const std::vector<char> features = features_of(of_used(settings.select_by), settings);
    for (std::size_t k = 0; k < used.size(); ++k) {
        result.counters[static_cast<std::size_t>(used[k])] = counters[k];
        result.features[static_cast<std::size_t>(used[k])] = features[k];
    }
    result.report.vertices = static_cast<int>(used.size());
    result.report.mean_counter = mean(counters);
    result.report.feature_vertices = static_cast<int>(std::count(features.begin(), features.end(), 1));
}

}  // namespace

MeshCounters mesh_counters(const IndexedMesh<double>& mesh, const TargetSpace& target,
                           const Settings& settings, Progress& progress) {
    const auto begin = std::chrono::steady_clock::now();
    settings.check(counter_table());
    MonotoneProgress monotone(progress);
    LearningTask task = points_to_learn(target, settings);
    const WorkingCopy copy = copy_of(given_start(mesh, task.target(), GivenAs::current_layer));
    LearnerOptions options = learner_options_from(settings);
    options.grow_to = copy.network.vertex_count();
    Learner learner(task.target(), options, copy.network);
    const CreaseMeasure moments = learn_around(copy.network, settings.signals_per_vertex, learner, monotone);

    MeshCounters result;
    result.counters.assign(mesh.positions.size(), 0.0F);
    result.features.assign(mesh.positions.size(), 0);
    write_measures(measures_of(learner, moments, copy.network, {}, settings), copy, settings, result);
    result.report.signals = learner.signals();
    result.report.outliers = task.outliers;
    result.report.warnings = std::move(task.warnings);
    if (monotone.stopped()) result.report.stop_reason = StopReason::cancelled;
    result.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

}  // namespace neuralmesh
