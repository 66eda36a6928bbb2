// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Right normals of a cloud are told from wrong ones.
#include "vcg_core/cloud/normal_survey.h"

#include <gtest/gtest.h>

#include "tests/unit/support/normal_clouds.h"

namespace neuralmesh {
namespace {

using namespace normal_clouds;

NormalSurvey survey_of(const Cloud& cloud, const std::vector<PackedNormal>& normals) {
    std::vector<vcg::Point3f> points;
    for (const vcg::Point3d& p : cloud) points.push_back(vcg::Point3f::Construct(p));
    Surveys surveys(points, 1);
    return survey_of_normals(surveys, normals);
}

TEST(NormalSurvey, AcceptsRightNormalsOfEitherSide) {
    const Cloud cloud = shapes::sphere_cloud(20000);
    for (const auto& normals : {outward(cloud), inward(cloud)}) {
        const NormalSurvey found = survey_of(cloud, normals);
        EXPECT_GT(found.places, 480);
        EXPECT_GT(found.share_fitting(), 0.99);
        EXPECT_LT(found.share_opposite(), 0.001);
        EXPECT_TRUE(found.fits() && found.has_sides());
    }
}

TEST(NormalSurvey, AcceptsRightNormalsOfNoisyPoints) {
    // Noise of up to six spacings: the nearest neighbours show no plane.
    for (const double noise : {0.01, 0.05, 0.15}) {
        const Cloud cloud = shapes::sphere_cloud(20000, noise);
        const NormalSurvey found = survey_of(cloud, outward(shapes::sphere_cloud(20000)));
        EXPECT_TRUE(found.places == 0 || (found.fits() && found.has_sides()))
            << noise << ": " << found.places << " places, " << found.share_fitting();
    }
}

TEST(NormalSurvey, RefusesNonsense) {
    const Cloud cloud = shapes::sphere_cloud(20000);
    const NormalSurvey found = survey_of(cloud, nonsense(cloud.size()));
    EXPECT_FALSE(found.fits());
    EXPECT_NEAR(found.share_fitting(), 0.134, 0.05);
    // All the same: those of a plane.
    EXPECT_FALSE(survey_of(cloud, std::vector<PackedNormal>(cloud.size(), PackedNormal{0, 0, 127})).fits());
}

TEST(NormalSurvey, SeesRandomSides) {
    const Cloud cloud = shapes::sphere_cloud(20000);
    const NormalSurvey found = survey_of(cloud, flipped(outward(cloud), 2));
    EXPECT_TRUE(found.fits());
    EXPECT_FALSE(found.has_sides());
    EXPECT_NEAR(found.share_opposite(), 0.5, 0.05);
}

TEST(NormalSurvey, AcceptsBothSidesOfAWall) {
    Cloud cloud = shapes::sphere_cloud(20000);
    std::vector<PackedNormal> normals = outward(cloud);
    for (const vcg::Point3d& p : shapes::sphere_cloud(20000)) {  // three spacings below
        cloud.emplace_back(vcg::Point3d(-p[1], p[2], p[0]) * 0.925);
        normals.push_back(opposite(packed_point(cloud.back())));
    }
    const NormalSurvey found = survey_of(cloud, normals);
    EXPECT_TRUE(found.fits() && found.has_sides());
}

TEST(NormalSurvey, FindsNoPlaceWithoutNormalsOrWithoutSurface) {
    const Cloud cloud = shapes::sphere_cloud(1000);
    EXPECT_EQ(survey_of(cloud, std::vector<PackedNormal>(cloud.size(), kNoNormal)).places, 0);
    EXPECT_FALSE(survey_of(cloud, std::vector<PackedNormal>(cloud.size(), kNoNormal)).fits());
    const Cloud few = shapes::sphere_cloud(8);
    EXPECT_EQ(survey_of(few, outward(few)).places, 0);
    Cloud scattered;
    Random random(1);
    for (int i = 0; i < 3000; ++i) scattered.push_back(shapes::in_cube(random));
    EXPECT_LT(survey_of(scattered, outward(scattered)).places, 20);
}

}  // namespace
}  // namespace neuralmesh
