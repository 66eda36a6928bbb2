// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Telling one layer of points from the two sides of a thin wall.
#include "vcg_core/shell/two_layers.h"

#include <gtest/gtest.h>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Roughly normal, of variance 1.
float noise(Random& random) {
    float sum = -6;
    for (int i = 0; i < 12; ++i) sum += random.unit();
    return sum;
}

/// 20,000 points of a unit square bent by \p bend, in two layers \p apart, with noise across them.
LayerFigures figures_of_sheet(float bend, float apart, float across) {
    Random random(1);
    std::vector<Point3f> points;
    vcg::Box3f box;
    for (int i = 0; i < 20000; ++i) {
        const float x = random.unit(), y = random.unit();
        points.emplace_back(x, y, bend * x * x + (i % 2 == 0 ? apart : 0) + across * noise(random));
        box.Add(points.back());
    }
    return layer_figures(points, tangent_planes(points, box, TangentPlaneOptions()));
}

double kurtosis_of_sheet(float bend, float apart, float across) {
    return figures_of_sheet(bend, apart, across).kurtosis;
}

TEST(TwoLayers, AreSeenOnBothSidesOfAThinWall) {
    for (const float apart : {0.007F, 0.014F}) {  // one and two spacings
        EXPECT_LT(kurtosis_of_sheet(0, apart, 0), kTwoLayers) << apart;
        EXPECT_LT(kurtosis_of_sheet(0.3F, apart, 0.001F), kTwoLayers) << apart;
    }
}

TEST(TwoLayers, HaveAThicknessAndASpacing) {
    for (const float apart : {0.007F, 0.014F}) {
        const LayerFigures found = figures_of_sheet(0, apart, 0);
        EXPECT_TRUE(found.are_two());
        EXPECT_NEAR(found.thickness, static_cast<double>(apart), 0.1 * static_cast<double>(apart));
        EXPECT_NEAR(found.spacing, 0.01, 0.002);
    }
}

TEST(TwoLayers, AreNotSeenInOne) {
    EXPECT_GT(kurtosis_of_sheet(0, 0, 0), kTwoLayers);
    EXPECT_GT(kurtosis_of_sheet(1, 0, 0), kTwoLayers);
    EXPECT_GT(kurtosis_of_sheet(0, 0, 0.003F), kTwoLayers);
    EXPECT_GT(kurtosis_of_sheet(0.3F, 0, 0.02F), kTwoLayers);
}

TEST(TwoLayers, AreNotSeenInTwoNoisyViews) {
    EXPECT_GT(kurtosis_of_sheet(0.3F, 0.007F, 0.0025F), kTwoLayers);
}

}  // namespace
}  // namespace neuralmesh
