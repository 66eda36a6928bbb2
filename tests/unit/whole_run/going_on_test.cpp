// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Learning that goes on from a mesh of the user's: what it saves, and what stays.
#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::going_on_test {

Settings going_on(int vertices) { return with_target(vertices, kGivenMesh); }

/// A coarse result as the start of a finer one: as good as a new run, with fewer splits.
TEST(GoingOn, RefinesAnEarlierResult) {
    const TargetSpace torus = target_of(shapes::torus_cloud(20000));
    const NeuralMesh coarse = learn(torus, with_target(2500));
    const NeuralMesh fine = learn_exactly(torus, going_on(5000), {coarse.positions, coarse.faces});
    EXPECT_EQ(fine.report.genus, 1);
    const NeuralMesh anew = learn(torus, with_target(5000));
    // Most of the splits that made the vertices of the earlier result are saved.
    EXPECT_LT(static_cast<double>(fine.report.splits), static_cast<double>(anew.report.splits) - 0.7 * 2500);
    EXPECT_LT(fine.report.rms_error, 1.05 * anew.report.rms_error);
    const NeuralMesh same = learn_exactly(torus, going_on(2500), {coarse.positions, coarse.faces});
    EXPECT_LT(same.report.rms_error, 1.1 * coarse.report.rms_error);
}

/// A ring without its two discs: the boundaries stay though the points enclose space there.
TEST(GoingOn, KeepsBoundariesHandlesAndComponents) {
    Shape start = shapes::torus_grid(16, 8);
    start.faces.resize(start.faces.size() - 2);
    const auto given = census(start.faces);
    const TargetSpace torus = target_of(shapes::torus_cloud(20000));
    const NeuralMesh mesh = learn_exactly(torus, going_on(600), start);
    EXPECT_EQ(topology_of(mesh), (Topology{1, 1, given.loops}));
    EXPECT_EQ(mesh.report.topology_confidence, 0);
    Settings closed = going_on(600);
    closed.surface = kClosedSurface;
    EXPECT_TRUE(has_warning(learn(torus, closed, start), "because the start layer is"));
}

TEST(GoingOn, FacesTheSideThatTheStartFaces) {
    const TargetSpace square = target_of(shapes::plane_cloud(8000));
    for (const bool down : {false, true}) {
        Shape start = shapes::grid(10, 10);
        if (down)
            for (auto& f : start.faces) std::swap(f[1], f[2]);
        const NeuralMesh mesh = learn(square, going_on(400), start);
        double up = 0;
        for (const Triangle& f : mesh.faces) up += area_of(mesh, f)[2];
        EXPECT_EQ(up < 0, down);
    }
}

}  // namespace neuralmesh::going_on_test
