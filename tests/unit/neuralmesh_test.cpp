// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The umbrella header is all that a caller includes, and the example in its manual, which CMake copies from
// there, does what it says.
#include "vcg_core/neuralmesh.h"

#include <iostream>

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh::neuralmesh_test {

#include "example_of_manual.inc"

/// The lines of an OBJ file: their words \p v or \p f and three numbers.
std::vector<std::array<double, 3>> lines_of(const std::string& obj, const std::string& word) {
    std::istringstream in(obj);
    std::vector<std::array<double, 3>> found;
    std::array<double, 3> numbers{};
    for (std::string first; in >> first >> numbers[0] >> numbers[1] >> numbers[2];)
        if (first == word) found.push_back(numbers);
    EXPECT_TRUE(in.eof());
    return found;
}

TEST(Manual, ItsExampleWritesAMeshOfTheSphere) {
    std::stringstream in;
    for (const vcg::Point3d& p : shapes::sphere_cloud(3000))
        in << 7 + 2 * p[0] << ' ' << 2 * p[1] << ' ' << 2 * p[2] << '\n';
    std::ostringstream out;
    mesh_of_points(in, out);
    const auto vertices = lines_of(out.str(), "v");
    const auto faces = lines_of(out.str(), "f");
    EXPECT_EQ(vertices.size(), 1000U);
    EXPECT_EQ(faces.size(), 1996U);
    for (const auto& p : vertices) EXPECT_NEAR((vcg::Point3d(p[0] - 7, p[1], p[2])).Norm(), 2, 0.02);
    for (const auto& corners : faces)
        for (const double corner : corners) EXPECT_TRUE(corner >= 1 && corner <= 1000) << corner;
}

TEST(Manual, EveryErrorIsASentence) {
    std::istringstream nothing;
    std::ostringstream out;
    EXPECT_NE(complaint_of([&] { mesh_of_points(nothing, out); }), "");
    EXPECT_TRUE(out.str().empty());
}

/// Of what the manual names, that each is declared by the one include.
TEST(Manual, OneIncludeDeclaresAll) {
    const auto ball = shapes::sphere_cloud(400);
    const TargetSpace target = TargetSpace::points(ball.size(), [&](std::size_t i) { return ball[i]; });
    Settings settings;
    settings.target_vertices = 50;
    settings.crease_lines = true;
    NoProgress progress;
    const NeuralMesh mesh = reconstruct(target, settings, progress);
    EXPECT_EQ(mesh.report.stop_reason, StopReason::target_reached);
    EXPECT_TRUE(mesh.report.warnings.empty());
    IndexedMesh<double> given;
    given.positions = mesh.positions;
    given.faces = mesh.faces;
    settings.signals_per_vertex = 10;
    const MeshCounters counters = mesh_counters(given, target, settings, progress);
    EXPECT_EQ(counters.counters.size(), 50U);
    settings.target_vertices = 0;
    EXPECT_THROW(reconstruct(target, settings, progress), SettingError);
    settings.signals_per_vertex = 0;
    EXPECT_THROW(settings.check(counter_table()), SettingError);
}

}  // namespace neuralmesh::neuralmesh_test
