// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/feature_measures.h"

#include "vcg_core/paper/counters.h"

namespace neuralmesh {

FeatureMeasures measures_of(const Learner& learner, const CreaseMeasure& observed, const Network& shown,
                            const PerVertex<VertexId>& source, const Settings& settings) {
    FeatureMeasures measures;
    if (settings.uses(kCreaseMeasure)) {
        ThreadTeam team(thread_count(settings.threads));
        measures.creases = observed.values(learner.network(), shown, source, team);
    }
    if (!settings.uses(kFeatureCounter)) return measures;
    measures.normal_counters.resize(shown.slot_count());
    for (const VertexId v : shown.vertices())
        measures.normal_counters[v] = learner.feature_counters().value(source.empty() ? v : source[v]);
    return measures;
}

double mean(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) sum += static_cast<double>(value);
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

std::vector<char> features_of(const std::vector<float>& measure, const Settings& settings) {
    // The crease measure is an angle: dividing it by its mean would make models less comparable.
    const double threshold = settings.select_by == kCreaseMeasure
                                 ? settings.feature_threshold
                                 : feature_threshold(settings.feature_threshold, mean(measure));
    std::vector<char> features;
    features.reserve(measure.size());
    for (const float value : measure) features.push_back(static_cast<double>(value) > threshold ? 1 : 0);
    return features;
}

}  // namespace neuralmesh
