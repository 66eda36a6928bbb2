// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/target/noise_by_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

constexpr int kPointsOfPlane = 20000;
constexpr float kSpacing = 0.014142F;  // of as many points on the square of side 2

/// A flat square: points with x > 0 are \p noise off it, to either side by chance.
NoiseByPlace half_noisy(float noise) {
    Random random(1);
    std::vector<vcg::Point3f> points;
    for (int i = 0; i < kPointsOfPlane; ++i) {
        const float x = 2 * random.unit() - 1, y = 2 * random.unit() - 1;
        // The sum of twelve has a deviation of 1.
        float z = -6;
        for (int k = 0; k < 12; ++k) z += random.unit();
        points.emplace_back(x, y, x > 0 ? noise * z : 0);
    }
    ThreadTeam team(1);
    return NoiseByPlace(SurfaceSurvey(CloudSurvey(points, 1), team));
}

TEST(NoiseByPlace, IsWhereThePointsAreNoisy) {
    const NoiseByPlace noise = half_noisy(kSpacing);
    EXPECT_NEAR(std::sqrt(noise.variance_at({0.6F, 0, 0})) / kSpacing, 1, 0.2);
    EXPECT_LT(noise.variance_at({-0.6F, 0, 0}), 1e-6F * kSpacing * kSpacing);
    EXPECT_GT(noise.least_squared_edge_at({0.6F, 0, 0}), 10 * kSpacing * kSpacing);
}

TEST(NoiseByPlace, LetsPointsCarryFewerVertices) {
    EXPECT_NEAR(static_cast<double>(half_noisy(0).carried_by(kPointsOfPlane)), kPointsOfPlane / 2,
                0.02 * kPointsOfPlane);
    const double noisy = static_cast<double>(half_noisy(kSpacing).carried_by(kPointsOfPlane));
    EXPECT_LT(noisy, 0.32 * kPointsOfPlane) << "hardly any on the noisy half";
    EXPECT_GT(noisy, 0.2 * kPointsOfPlane) << "as many as before on the other";
}

}  // namespace
}  // namespace neuralmesh
