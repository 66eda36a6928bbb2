// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs, settings that differ in all that changes their course, progress that checks what it is told,
// and what holds for every result.
#pragma once

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {

inline Topology topology_of(const NeuralMesh& mesh) {
    return {mesh.report.components, mesh.report.genus, mesh.report.boundary_loops};
}

inline NeuralMesh learn(const TargetSpace& target, const Settings& settings,
                        const IndexedMesh<double>& start = {}) {
    return reconstruct(target, settings, unwatched(), start);
}

inline NeuralMesh learn(const Cloud& cloud, const Settings& settings, const IndexedMesh<double>& start = {}) {
    return learn(target_of(cloud), settings, start);
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

// Properties of every result of reconstruct(), for any input and settings, complete or cancelled.

/// The mesh is an oriented manifold with the figures of its report, and all numbers are finite.
inline void expect_sound(const NeuralMesh& mesh) {
    const Census found = census(mesh.faces);
    EXPECT_EQ(found.breach, "");
    EXPECT_EQ(found.vertices, static_cast<int>(mesh.positions.size()));
    EXPECT_LE(found.greatest_valence(), Ring::kMaxValence);
    EXPECT_EQ(found.vertices, mesh.report.vertices);
    EXPECT_EQ(found.faces, mesh.report.faces);
    EXPECT_EQ(found.components, mesh.report.components);
    EXPECT_EQ(found.loops, mesh.report.boundary_loops);
    EXPECT_EQ(found.euler(), 2 * mesh.report.components - 2 * mesh.report.genus - mesh.report.boundary_loops);
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

/// What is learned of a cloud or a target, exactly as it is asked for.
template <class Points>
NeuralMesh learn_exactly(const Points& points, const Settings& settings,
                         const IndexedMesh<double>& start = {}) {
    NeuralMesh mesh = learn(points, settings, start);
    expect_exact(mesh, settings);
    return mesh;
}

/// True if a warning of the report contains \p words.
inline bool has_warning(const NeuralMesh& mesh, const std::string& words) {
    return has_one(mesh.report.warnings, words);
}

inline bool has_note(const NeuralMesh& mesh, const std::string& words) {
    return has_one(mesh.report.notes, words);
}

}  // namespace neuralmesh
