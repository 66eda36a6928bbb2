// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Whole runs on clouds of uneven density.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/soundness.h"
#include "vcg_core/reconstruct.h"

namespace neuralmesh {
namespace {

Settings settings_of(bool even, int vertices = 500) {
    Settings settings;
    settings.target_vertices = vertices;
    settings.even_sampling = even;
    return settings;
}

NeuralMesh learned(const shapes::Cloud& cloud, const Settings& settings) {
    NoProgress progress;
    return reconstruct(soundness::target_of(cloud), settings, progress);
}

int upper_vertices(const NeuralMesh& mesh) {
    int count = 0;
    for (const vcg::Point3d& p : mesh.positions) count += p[2] > 0 ? 1 : 0;
    return count;
}

// The unit sphere's upper half has a twentieth of the points.
TEST(EvenSampling, SpreadsTheVerticesEvenly) {
    const shapes::Cloud cloud = shapes::uneven_sphere_cloud(20000, 20);
    EXPECT_NEAR(upper_vertices(learned(cloud, settings_of(true))), 250, 40);
    EXPECT_LT(upper_vertices(learned(cloud, settings_of(false))), 190);
}

TEST(EvenSampling, LeavesEvenCloudsAlone) {
    const shapes::Cloud cloud = shapes::sphere_cloud(5000, 0.01);
    EXPECT_EQ(learned(cloud, settings_of(true)).positions, learned(cloud, settings_of(false)).positions);
}

TEST(EvenSampling, LeavesTheSignalCounterAlone) {
    const shapes::Cloud cloud = shapes::uneven_sphere_cloud(5000, 20);
    Settings on = settings_of(true);
    Settings off = settings_of(false);
    on.utility_counter = off.utility_counter = kSignalCount;
    EXPECT_EQ(learned(cloud, on).positions, learned(cloud, off).positions);
}

}  // namespace
}  // namespace neuralmesh
