// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs on clouds with normals: what they orient, and what the log says.
#include "tests/unit/support/normal_clouds.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::layer_normals_test {

constexpr const char* kFollowed = "faces the side to which the normals";

NeuralMesh learn(const TargetSpace& target, int surface = kAutomatic, bool use_normals = true) {
    Settings settings = with_target(300);
    settings.surface = surface;
    settings.use_normals = use_normals;
    settings.vertex_color = kNoColors;
    settings.settling_signals_per_vertex = 5;
    return learn(target, settings);
}

/// The share of the faces that face away from the origin.
double share_facing_out(const NeuralMesh& mesh) {
    double out = 0;
    for (const Triangle& f : mesh.faces) out += corner(mesh, f, 0) * area_of(mesh, f) > 0 ? 1 : 0;
    return out / static_cast<double>(mesh.faces.size());
}

void expect_same(const NeuralMesh& a, const NeuralMesh& b) {
    EXPECT_TRUE(a.positions == b.positions);
    EXPECT_EQ(a.faces, b.faces);
    EXPECT_EQ(a.counters, b.counters);
}

TEST(LayerNormals, OrientAnOpenSurface) {
    const Cloud cloud = bowl(8000);
    for (const int surface : {kAutomatic, kOpenSurface}) {
        for (const bool in : {false, true}) {
            const NeuralMesh mesh = learn(target_of(cloud, in ? inward(cloud) : outward(cloud)), surface);
            expect_sound(mesh);
            EXPECT_EQ(mesh.report.boundary_loops, 1);
            EXPECT_TRUE(has_note(mesh, kFollowed));
            EXPECT_FALSE(has_warning(mesh, "normals"));
            const double out = share_facing_out(mesh);
            EXPECT_GT(in ? 1 - out : out, 0.98);
        }
    }
}

TEST(LayerNormals, OfRepeatedPointsAndOutliersComeAlong) {
    Cloud cloud = bowl(8000);
    const std::size_t once = cloud.size();
    cloud.insert(cloud.end(), cloud.begin(), cloud.begin() + static_cast<std::ptrdiff_t>(once / 2));
    std::vector<PackedNormal> normals = inward(cloud);
    Random random(2);
    for (int i = 0; i < 60; ++i) {
        cloud.push_back(shapes::in_ball(random).Normalize() * 1.5);
        normals.push_back(packed_point(cloud.back()));
    }
    const NeuralMesh mesh = learn(target_of(cloud, normals));
    EXPECT_TRUE(has_warning(mesh, "repeat others"));
    EXPECT_GT(mesh.report.outliers, 20);
    EXPECT_TRUE(has_note(mesh, kFollowed));
    EXPECT_LT(share_facing_out(mesh), 0.02);
}

TEST(LayerNormals, AreNotUsedIfTheyAreWrong) {
    const Cloud cloud = bowl(8000);
    const NeuralMesh without = learn(target_of(cloud));
    const NeuralMesh sides = learn(target_of(cloud, flipped(outward(cloud), 2)));
    EXPECT_TRUE(has_warning(sides, "point to either side of the surface"));
    expect_same(sides, without);
    const NeuralMesh wrong = learn(target_of(cloud, nonsense(cloud.size())));
    EXPECT_TRUE(has_warning(wrong, "do not fit the points (1"));
    expect_same(wrong, without);
    EXPECT_FALSE(has_note(wrong, kFollowed));
}

TEST(LayerNormals, OfPartsThatDisagreeAreNotUsed) {
    const Cloud cloud = bowl(8000);
    std::vector<PackedNormal> normals = inward(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (cloud[i][0] > 0) normals[i] = opposite(normals[i]);
    const NeuralMesh mesh = learn(target_of(cloud, normals));
    EXPECT_TRUE(has_warning(mesh, "point to both sides of 1 of the 1 parts"));
    EXPECT_FALSE(has_note(mesh, kFollowed));
    expect_same(mesh, learn(target_of(cloud)));
}

TEST(LayerNormals, ThatAreSwitchedOffAreNone) {
    const Cloud cloud = bowl(8000);
    const NeuralMesh without = learn(target_of(cloud));
    const NeuralMesh off = learn(target_of(cloud, inward(cloud)), kAutomatic, false);
    expect_same(off, without);
    EXPECT_TRUE(off.report.notes.empty());
    EXPECT_EQ(off.report.warnings, without.report.warnings);
}

TEST(LayerNormals, OfAClosedSurfaceChangeNothing) {
    const Cloud cloud = shapes::sphere_cloud(10000);
    const NeuralMesh without = learn(target_of(cloud));
    const NeuralMesh out = learn(target_of(cloud, outward(cloud)));
    expect_same(out, without);
    EXPECT_TRUE(has_note(out, "A closed surface faces out without them"));
    EXPECT_TRUE(out.report.warnings.empty());
    const NeuralMesh in = learn(target_of(cloud, inward(cloud)));
    expect_same(in, without);
    EXPECT_TRUE(has_warning(in, "point inwards (100.0 %): they are not used"));
    EXPECT_TRUE(in.report.notes.empty());
}

TEST(LayerNormals, ThatCannotBeComparedAreNotUsed) {
    Random random(1);
    Cloud cloud;
    for (int i = 0; i < 9; ++i) cloud.push_back(shapes::in_ball(random));
    EXPECT_TRUE(has_warning(learn(target_of(cloud, outward(cloud))), "cannot be compared with the points"));
}

}  // namespace neuralmesh::layer_normals_test
