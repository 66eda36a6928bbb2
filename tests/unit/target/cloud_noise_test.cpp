// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The estimate of a cloud's noise beside the edges of a mesh.
#include "vcg_core/target/cloud_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

constexpr int kPoints = 50000;

double noise_of(const shapes::Cloud& cloud, int vertices, int threads = 1) {
    std::vector<vcg::Point3f> points;
    for (const vcg::Point3d& p : cloud) points.push_back(vcg::Point3f::Construct(p));
    return noise_in_edges(CloudSurvey(points, threads), static_cast<double>(points.size()) / vertices);
}

/// Mean edge of an even mesh of the unit sphere.
double edge_of_sphere(int vertices) { return std::sqrt(4 * M_PI / vertices / (std::sqrt(3.0) / 2)); }

TEST(CloudNoise, IsTheStandardDeviationInEdges) {
    for (const int vertices : {1000, 4000})
        for (const double share : {0.025, 0.05, 0.1}) {
            // In a ball, the deviation along an axis is the radius over the root of five.
            const double noise = share * edge_of_sphere(vertices) * std::sqrt(5.0);
            const double found = noise_of(shapes::sphere_cloud(kPoints, noise), vertices);
            EXPECT_NEAR(found, share, 0.1 * share) << vertices;
        }
}

TEST(CloudNoise, IsSmallForACleanCurvedSurface) {
    for (const int vertices : {500, 2000, 5000}) {
        EXPECT_LT(noise_of(shapes::sphere_cloud(kPoints), vertices), 0.03) << vertices;
        EXPECT_LT(noise_of(shapes::plane_cloud(kPoints), vertices), 1e-5) << vertices;
    }
}

TEST(CloudNoise, IsFiniteForPointsWithoutASurface) {
    EXPECT_EQ(noise_of(shapes::Cloud(100, vcg::Point3d(1, 2, 3)), 10), 0);
    EXPECT_EQ(noise_of(shapes::sphere_cloud(10), 5), 0);
    EXPECT_TRUE(std::isfinite(noise_of(shapes::sphere_cloud(20, 0.5), 5)));
}

}  // namespace
}  // namespace neuralmesh
