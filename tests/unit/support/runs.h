// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs, settings that differ in all that changes their course, and progress that checks what it is
// told.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh::runs {

inline NeuralMesh learn(const TargetSpace& target, const Settings& settings,
                        const IndexedMesh<double>& start = {}) {
    NoProgress progress;
    return reconstruct(target, settings, progress, start);
}

inline NeuralMesh learn(const shapes::Cloud& cloud, const Settings& settings,
                        const IndexedMesh<double>& start = {}) {
    return learn(targets::target_of(cloud), settings, start);
}

inline Settings with_target(int vertices, int start_mesh = kShell) {
    Settings settings;
    settings.target_vertices = vertices;
    settings.start_mesh = start_mesh;
    return settings;
}

/// Both start meshes, with and without fit, both utility counters; and the defaults.
inline std::vector<Settings> variants() {
    std::vector<Settings> result;
    for (int i = 0; i < 4; ++i) {
        Settings settings = with_target(300, (i & 1) != 0 ? kTetrahedron : kShell);
        settings.fit_to_points = (i & 2) != 0;
        settings.utility_counter = i == 1 || i == 2 ? kSignalCount : kNormalVariation;
        result.push_back(settings);
    }
    // Few vertices, so that the network grows to more and the fit removes some.
    result.push_back(with_target(60));
    return result;
}

/// Checks fractions and texts; asks to stop after \p patience calls.
class Watch : public Progress {
public:
    explicit Watch(int patience = 1 << 30) : patience_(patience) {}

    bool operator()(double fraction, const char* text) override {
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1);
        steps_back += fraction < last ? 1 : 0;
        standing_still += calls > 0 && fraction == last ? 1 : 0;
        last = fraction;
        EXPECT_GT(std::string(text).size(), 3U);
        return ++calls <= patience_;
    }

    bool stopped() const { return calls > patience_; }

    int calls = 0;
    int steps_back = 0;
    int standing_still = 0;
    double last = 0;

private:
    int patience_;
};

}  // namespace neuralmesh::runs
