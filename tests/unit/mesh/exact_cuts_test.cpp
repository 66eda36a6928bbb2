// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Apparent self-crossings are told from true ones.
#include "vcg_core/mesh/exact_cuts.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/support/crumpled.h"

namespace neuralmesh {
namespace {

TEST(ExactCuts, FacesApartInATiltedPlaneDoNotCutEachOther) {
    std::size_t apparent = 0;
    for (const double tilt : {0.01, 0.1, 0.3, 0.7}) {
        shapes::Shape sheet = shapes::grid(12, 12);
        for (vcg::Point3d& p : sheet.positions) p += vcg::Point3d(0.013, tilt * p[0] + 0.021, 0.3 * p[1]);
        const Surface surface(referee::network_of(sheet));
        std::vector<SelfCrossing> found = crossings(surface, 1);
        apparent += found.size();
        drop_apparent(surface, found);
        EXPECT_TRUE(found.empty()) << tilt;
    }
    EXPECT_GT(apparent, 0) << "else the test shows nothing";
}

TEST(ExactCuts, TrueCrossingsStay) {
    for (const double noise : {0.1, 0.4}) {
        const Surface surface(crumpled_sphere(noise));
        const std::vector<SelfCrossing> all = crossings(surface, 1);
        ASSERT_FALSE(all.empty());
        std::vector<SelfCrossing> left = all;
        drop_apparent(surface, left);
        EXPECT_EQ(left, all) << noise;
    }
}

}  // namespace
}  // namespace neuralmesh
