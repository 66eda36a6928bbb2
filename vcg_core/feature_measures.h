// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The two measures of how much of a feature a vertex is, as both filters hand them over.
#pragma once

#include <vector>

#include "vcg_core/learning/learner.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// Per vertex of a network. Empty if the settings do not use the measure.
struct FeatureMeasures {
    PerVertex<float> normal_counters, creases;

    /// \p measure is one of FeatureMeasure that the settings use.
    const PerVertex<float>& values(int measure) const {
        return measure == kCreaseMeasure ? creases : normal_counters;
    }
};

/// What \p learner and \p observed tell of the vertices of \p shown. \p source: the learner's vertex that
/// each takes its values from; empty: itself. O(vertices)
FeatureMeasures measures_of(const Learner& learner, const CreaseMeasure& observed, const Network& shown,
                            const PerVertex<VertexId>& source, const Settings& settings);

/// 0 if there are none.
double mean(const std::vector<float>& values);

/// 1 for every vertex whose measure, that which settings.select_by names, is above
/// settings.feature_threshold.
std::vector<char> features_of(const std::vector<float>& measure, const Settings& settings);

}  // namespace neuralmesh
