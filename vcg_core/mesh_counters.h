// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The counters of a mesh that is given: how much of a feature each of its vertices is.
#pragma once

#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/result.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// Per vertex of a given mesh, in its order; both are 0 for a vertex that no face uses.
struct MeshCounters {
    std::vector<float> counters;  ///< >= 0: the measure that settings.feature_measure names
    /// 1 if the measure that settings.select_by names is above settings.feature_threshold.
    std::vector<char> features;
    /// Of its figures vertices (those of faces), signals, feature_vertices, mean_counter, seconds,
    /// stop_reason, outliers and warnings.
    Report report;
};

/// Lets a copy of \p mesh, in the coordinates of the input, learn \p target at fixed connectivity: Basic
/// Steps as those that end a reconstruction. The copy returns to the given places whenever it has learned 20
/// signals per vertex, because vertices that learn longer drift away from them: towards the middle of their
/// signals, and off creases. Counters and crease measure go on over all rounds, as many as
/// settings.signals_per_vertex needs; in all at least 60,000 signals.
///
/// Repeated points of a cloud, if they are more than a tenth, and outliers are not learned; report.warnings
/// says how many they are. If \p progress asks to stop, the values are those so far. The same arguments give
/// the same bytes on any x86-64 machine and with any settings.threads. Besides the settings
/// of counter_table() it reads remove_outliers and the paper's constants.
///
/// \throws SettingError (a parameter is out of range), what given_start() throws, std::bad_alloc
///
/// Cost: signals of O(1) expected time each, and 0.6 kB per vertex.
MeshCounters mesh_counters(const IndexedMesh<double>& mesh, const TargetSpace& target,
                           const Settings& settings, Progress& progress);

}  // namespace neuralmesh
