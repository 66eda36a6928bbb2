// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Crease lines of whole runs: made where the settings ask for them and the cloud has creases.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/unit/support/cube_edges.h"
#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

NeuralMesh lined(const shapes::Cloud& cloud, bool wanted) {
    Settings settings;
    settings.target_vertices = 600;
    settings.crease_lines = wanted;
    NoProgress progress;
    return reconstruct(soundness::target_of(cloud), settings, progress);
}

bool has_note(const NeuralMesh& mesh, const std::string& words) {
    const std::vector<std::string>& all = mesh.report.notes;
    return std::any_of(all.begin(), all.end(),
                       [&](const std::string& note) { return note.find(words) == 0; });
}

TEST(CreaseLayer, IsMadeIfTheSettingsAskForIt) {
    const shapes::Cloud box = shapes::box_cloud(20000, {2, 2, 2});
    const NeuralMesh mesh = lined(box, true);
    EXPECT_EQ(mesh.report.crease_lines, 12);
    EXPECT_TRUE(has_note(mesh, "The mesh has 12 crease lines with 8 corners"));
    ASSERT_EQ(mesh.creases.measures.size(), mesh.creases.positions.size());
    for (const vcg::Point3d& p : mesh.creases.positions)
        EXPECT_LT(distance_from_edge(vcg::Point3f::Construct(p)), 0.03);

    const NeuralMesh without = lined(box, false);
    EXPECT_EQ(without.report.crease_lines, 0);
    EXPECT_TRUE(without.creases.edges.empty());
    EXPECT_EQ(without.positions, mesh.positions);
}

TEST(CreaseLayer, IsNotMadeOfASmoothSurface) {
    const NeuralMesh mesh = lined(shapes::sphere_cloud(20000), true);
    EXPECT_EQ(mesh.report.crease_lines, 0);
    EXPECT_TRUE(mesh.creases.edges.empty());
    EXPECT_TRUE(has_note(mesh, "The mesh has no creases"));
}

}  // namespace
}  // namespace neuralmesh
