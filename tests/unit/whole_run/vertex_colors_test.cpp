// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The colours of a whole run: the cloud's, the counter's or none.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

using shapes::Cloud;

constexpr Color kRed{255, 0, 0}, kBlue{0, 0, 255};

NeuralMesh learn_colored(const TargetSpace& target, int vertex_color) {
    Settings settings;
    settings.target_vertices = 300;
    settings.vertex_color = vertex_color;
    NoProgress progress;
    return reconstruct(target, settings, progress);
}

/// Red points on a sphere whose density varies; some are given twice, and then blue; blue outliers.
TargetSpace red_ball_in_blue_dust() {
    Cloud cloud = shapes::uneven_sphere_cloud(6000, 10, 0.01);
    const std::size_t red = cloud.size();
    cloud.insert(cloud.end(), cloud.begin(), cloud.begin() + 1500);
    Random random(2);
    for (int i = 0; i < 60; ++i) cloud.push_back(shapes::in_ball(random).Normalize() * 1.5);
    TargetSpace target = targets::target_of(cloud);
    std::vector<Color> colors(cloud.size(), kBlue);
    std::fill_n(colors.begin(), red, kRed);
    target.set_colors(colors);
    return target;
}

TEST(VertexColors, OfOutliersDoNotCount) {
    const NeuralMesh mesh = learn_colored(red_ball_in_blue_dust(), kCloudColors);
    EXPECT_TRUE(soundness::has_warning(mesh, "repeat others"));
    EXPECT_GT(mesh.report.outliers, 20);
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    for (const Color& color : mesh.colors) {
        EXPECT_GT(color[0], 250);
        EXPECT_LT(color[2], 5);
    }
    for (const std::string& note : mesh.report.notes) EXPECT_EQ(note.find("no colours"), std::string::npos);
}

TEST(VertexColors, GiveWayToTheCounterOrToNone) {
    const TargetSpace red = red_ball_in_blue_dust();
    const NeuralMesh counter = learn_colored(red, kCounterColors);
    const Cloud plain = shapes::sphere_cloud(2000);
    const NeuralMesh without = learn_colored(targets::target_of(plain), kCloudColors);
    ASSERT_EQ(without.report.notes.size(), 1U);
    EXPECT_EQ(without.report.notes.front().find("The layer has no colours"), 0U);
    EXPECT_EQ(without.colors, learn_colored(targets::target_of(plain), kCounterColors).colors);
    EXPECT_EQ(counter.colors.size(), counter.positions.size());
    EXPECT_NE(counter.colors, std::vector<Color>(counter.colors.size(), counter.colors.front()));
    EXPECT_TRUE(learn_colored(red, kNoColors).colors.empty());
}

}  // namespace
}  // namespace neuralmesh
