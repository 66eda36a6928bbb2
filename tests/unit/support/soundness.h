// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Properties of every result of reconstruct(), for any input and settings, complete or cancelled.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/support/referee.h"
#include "tests/unit/support/sentences.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh::soundness {

using targets::target_of;

/// The mesh is an oriented manifold with the figures of its report, and all numbers are finite.
inline void expect_sound(const NeuralMesh& mesh) {
    const referee::Census census = referee::census(mesh.faces);
    EXPECT_EQ(census.breach, "");
    EXPECT_EQ(census.vertices, static_cast<int>(mesh.positions.size()));
    EXPECT_LE(census.greatest_valence(), Ring::kMaxValence);
    EXPECT_EQ(census.vertices, mesh.report.vertices);
    EXPECT_EQ(census.faces, mesh.report.faces);
    EXPECT_EQ(census.components, mesh.report.components);
    EXPECT_EQ(census.loops, mesh.report.boundary_loops);
    EXPECT_EQ(census.euler(),
              2 * mesh.report.components - 2 * mesh.report.genus - mesh.report.boundary_loops);
    ASSERT_EQ(mesh.counters.size(), mesh.positions.size());
    ASSERT_EQ(mesh.features.size(), mesh.positions.size());
    int features = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_TRUE((mesh.positions[i] - mesh.positions[i]) == vcg::Point3d(0, 0, 0)) << i;
        EXPECT_TRUE(mesh.counters[i] >= 0 && mesh.counters[i] < 1e30F) << i << ": " << mesh.counters[i];
        features += mesh.features[i];
    }
    EXPECT_EQ(features, mesh.report.feature_vertices);
    EXPECT_TRUE(mesh.report.rms_error >= 0 && mesh.report.rms_error < 1000);
}

inline void expect_exact(const NeuralMesh& mesh, const Settings& settings) {
    expect_sound(mesh);
    EXPECT_EQ(mesh.report.vertices, settings.target_vertices);
    EXPECT_EQ(mesh.report.stop_reason, StopReason::target_reached);
}

/// True if a warning of the report contains \p words.
inline bool has_warning(const NeuralMesh& mesh, const std::string& words) {
    return sentences::has_one(mesh.report.warnings, words);
}

inline bool has_note(const NeuralMesh& mesh, const std::string& words) {
    return sentences::has_one(mesh.report.notes, words);
}

}  // namespace neuralmesh::soundness
