// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Normals in three bytes.
#include "vcg_core/base/packed_normal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

PackedNormal pack(const vcg::Point3d& n) { return packed({n[0], n[1], n[2]}); }

TEST(PackedNormal, KeepsTheDirectionOfAnyLength) {
    Random random(1);
    for (int i = 0; i < 10000; ++i) {
        const vcg::Point3d n = shapes::in_ball(random).Normalize();
        for (const double length : {1.0, 1e-300, 1e300}) {
            const PackedNormal small = pack(n * length);
            EXPECT_EQ(small, pack(n));
            const vcg::Point3d back = vcg::Point3d::Construct(unpacked(small));
            EXPECT_NEAR(back.Norm(), 1, 0.01);
            EXPECT_GT(back * n / back.Norm(), std::cos(0.4 * M_PI / 180));
        }
    }
}

TEST(PackedNormal, IsNoneOfWhatHasNoDirection) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const vcg::Point3d& n : {vcg::Point3d(0, 0, 0), vcg::Point3d(-0.0, 0, 0), vcg::Point3d(1, nan, 0),
                                  vcg::Point3d(infinity, 1, 0)})
        EXPECT_EQ(pack(n), kNoNormal);
    EXPECT_EQ(unpacked(kNoNormal), vcg::Point3f(0, 0, 0));
    EXPECT_EQ(pack({0, 0, -2}), (PackedNormal{0, 0, -127}));
}

}  // namespace
}  // namespace neuralmesh
