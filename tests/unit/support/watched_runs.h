// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs on clouds, and progress that checks what it is told.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh::watched_runs {

/// Checks fractions and texts; asks to stop after \p patience calls.
class Watch : public Progress {
public:
    explicit Watch(int patience = 1 << 30) : patience_(patience) {}

    bool operator()(double fraction, const char* text) override {
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1);
        if (fraction < last_) ++steps_back;
        last_ = fraction;
        EXPECT_GT(std::string(text).size(), 3U);
        return ++calls <= patience_;
    }

    int calls = 0;
    int steps_back = 0;

private:
    int patience_;
    double last_ = 0;
};

inline NeuralMesh learn_watched(const shapes::Cloud& cloud, const Settings& settings) {
    NoProgress progress;
    return reconstruct(targets::target_of(cloud), settings, progress);
}

inline Settings with_target(int vertices, int start_mesh = kShell) {
    Settings settings;
    settings.target_vertices = vertices;
    settings.start_mesh = start_mesh;
    return settings;
}

}  // namespace neuralmesh::watched_runs
