// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Settings that differ in all that changes the course of a run, for tests that compare bytes.
#pragma once

#include <vector>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh::run_variants {

inline NeuralMesh learn(const shapes::Cloud& cloud, const Settings& settings) {
    NoProgress progress;
    return reconstruct(targets::target_of(cloud), settings, progress);
}

/// Both start meshes, with and without fit, both utility counters; and the defaults.
inline std::vector<Settings> variants() {
    std::vector<Settings> result;
    for (int i = 0; i < 4; ++i) {
        Settings settings;
        settings.target_vertices = 300;
        settings.start_mesh = (i & 1) != 0 ? kTetrahedron : kShell;
        settings.fit_to_points = (i & 2) != 0;
        settings.utility_counter = i == 1 || i == 2 ? kSignalCount : kNormalVariation;
        result.push_back(settings);
    }
    // Few vertices, so that the network grows to more and the fit removes some.
    result.emplace_back();
    result.back().target_vertices = 60;
    return result;
}

}  // namespace neuralmesh::run_variants
