// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Learning that goes on from a mesh of the user's: what it saves, and what stays.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using runs::learn;
using shapes::Shape;

Settings going_on(int vertices) {
    Settings settings;
    settings.start_mesh = kGivenMesh;
    settings.target_vertices = vertices;
    return settings;
}

/// A coarse result as the start of a finer one: as good as a new run, with fewer splits.
TEST(GoingOn, RefinesAnEarlierResult) {
    const TargetSpace torus = targets::target_of(shapes::torus_cloud(20000));
    const NeuralMesh coarse = learn(torus, runs::with_target(2500));
    const NeuralMesh fine = learn(torus, going_on(5000), {coarse.positions, coarse.faces});
    soundness::expect_exact(fine, going_on(5000));
    EXPECT_EQ(fine.report.genus, 1);
    const NeuralMesh anew = learn(torus, runs::with_target(5000));
    // Most of the splits that made the vertices of the earlier result are saved.
    EXPECT_LT(static_cast<double>(fine.report.splits), static_cast<double>(anew.report.splits) - 0.7 * 2500);
    EXPECT_LT(fine.report.rms_error, 1.05 * anew.report.rms_error);
    const NeuralMesh same = learn(torus, going_on(2500), {coarse.positions, coarse.faces});
    soundness::expect_exact(same, going_on(2500));
    EXPECT_LT(same.report.rms_error, 1.1 * coarse.report.rms_error);
}

/// A ring without its two discs: the boundaries stay though the points enclose space there.
TEST(GoingOn, KeepsBoundariesHandlesAndComponents) {
    Shape start = shapes::torus_grid(16, 8);
    start.faces.resize(start.faces.size() - 2);
    const auto census = referee::census(start.faces);
    const TargetSpace torus = targets::target_of(shapes::torus_cloud(20000));
    const NeuralMesh mesh = learn(torus, going_on(600), start);
    soundness::expect_exact(mesh, going_on(600));
    EXPECT_EQ(mesh.report.boundary_loops, census.loops);
    EXPECT_EQ(mesh.report.components, 1);
    EXPECT_EQ(mesh.report.genus, 1);
    EXPECT_EQ(mesh.report.topology_confidence, 0);
    Settings closed = going_on(600);
    closed.surface = kClosedSurface;
    EXPECT_TRUE(soundness::has_warning(learn(torus, closed, start), "because the start layer is"));
}

TEST(GoingOn, FacesTheSideThatTheStartFaces) {
    const TargetSpace square = targets::target_of(shapes::plane_cloud(8000));
    for (const bool down : {false, true}) {
        Shape start = shapes::grid(10, 10);
        if (down)
            for (auto& f : start.faces) std::swap(f[1], f[2]);
        const NeuralMesh mesh = learn(square, going_on(400), start);
        double up = 0;
        for (const Triangle& f : mesh.faces) up += referee::area_of(mesh, f)[2];
        EXPECT_EQ(up < 0, down);
    }
}

}  // namespace
}  // namespace neuralmesh
