// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/plan.h"

#include <gtest/gtest.h>

#include <cmath>

namespace neuralmesh {
namespace {

Circumstances circumstances(int vertices, std::size_t points, double noise = 0) {
    Circumstances given;
    given.vertices = vertices;
    given.points = points;
    given.noise = noise;
    given.carried_by_points = points / 2;
    given.closed = true;
    return given;
}

constexpr int kVertices[] = {100, 500, 1000, 1500, 2000, 3000, 5000, 10000, 50000};

TEST(Plan, ChangesLittleWhereTheNoiseDoes) {
    constexpr double kStep = 0.0002;
    for (const int vertices : kVertices)
        for (double noise = 0; noise < 0.5; noise += kStep) {
            const Plan less = plan_for(circumstances(vertices, 1000000, noise));
            const Plan more = plan_for(circumstances(vertices, 1000000, noise + kStep));
            EXPECT_LE(more.grow_to, less.grow_to) << vertices << ' ' << noise;
            EXPECT_NEAR(more.grow_to, less.grow_to, 0.02 * less.grow_to + 80) << vertices << ' ' << noise;
            EXPECT_NEAR(more.growth_share, less.growth_share, 0.02) << vertices << ' ' << noise;
            EXPECT_NEAR(more.settling_share, less.settling_share, 0.02) << vertices << ' ' << noise;
        }
}

TEST(Plan, ChangesLittleWhereTheNumberOfPointsDoes) {
    for (const int vertices : kVertices)
        for (double points = vertices / 16; points < 1e6; points *= 1.01) {
            const Plan fewer = plan_for(circumstances(vertices, static_cast<std::size_t>(points)));
            const Plan more = plan_for(circumstances(vertices, static_cast<std::size_t>(1.01 * points)));
            EXPECT_GE(more.carried, fewer.carried) << vertices << ' ' << points;
            EXPECT_GE(more.grow_to, fewer.grow_to) << vertices << ' ' << points;
            EXPECT_LE(more.grow_to, 1.02 * fewer.grow_to + 1) << vertices << ' ' << points;
        }
}

TEST(Plan, ChangesLittleWhereTheVerticesAskedForDo) {
    for (const double noise : {0.0, 0.07, 0.12, 0.3})
        for (double vertices = 50; vertices < 1e5; vertices *= 1.01) {
            const Plan fewer = plan_for(circumstances(static_cast<int>(vertices), 1000000, noise));
            const Plan more = plan_for(circumstances(static_cast<int>(1.01 * vertices), 1000000, noise));
            EXPECT_NEAR(more.grow_to, fewer.grow_to, 0.05 * fewer.grow_to) << vertices << ' ' << noise;
            EXPECT_NEAR(more.growth_share, fewer.growth_share, 0.02) << vertices << ' ' << noise;
        }
}

TEST(Plan, PointsThatCarryFewerVerticesLeaveTheOthersToTheFit) {
    const Plan plan = plan_for(circumstances(10000, 8000));
    EXPECT_EQ(plan.carried, 4000);
    EXPECT_EQ(plan.grow_to, 4000);
    Circumstances exact = circumstances(10000, 8000);
    exact.exact = true;
    EXPECT_EQ(plan_for(exact).carried, 10000);
}

TEST(Plan, ShapeChoosesOnClosedSurfacesWithLittleNoiseAndFewOutliers) {
    Circumstances given = circumstances(5000, 100000);
    EXPECT_TRUE(plan_for(given).by_volume);
    given.closed = false;
    EXPECT_FALSE(plan_for(given).by_volume);
    given.closed = true;
    given.noise = 0.3;
    EXPECT_FALSE(plan_for(given).by_volume);
    given.noise = 0;
    given.outliers = 0.25;
    EXPECT_FALSE(plan_for(given).by_volume);
}

TEST(Plan, TheMoreIsRemovedAndTheLargerTheNoiseTheFewerSignalsDo) {
    EXPECT_LT(plan_for(circumstances(1000, 100000)).growth_share, 0.6);
    const double calm = plan_for(circumstances(6000, 20000, 0.02)).growth_share;
    EXPECT_LT(plan_for(circumstances(6000, 20000, 0.2)).growth_share, 0.6 * calm);
}

TEST(Plan, NothingIsRemovedThatTheFitMayNotRedistribute) {
    Circumstances given = circumstances(500, 100000);
    given.redistributes = false;
    const Plan plan = plan_for(given);
    EXPECT_EQ(plan.grow_to, 500);
    EXPECT_EQ(plan.growth_share, 1);
    EXPECT_EQ(plan.settling_share, 1);
}

}  // namespace
}  // namespace neuralmesh
