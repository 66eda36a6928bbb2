// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The widest boundary of a layer's faces.
#include "vcg_core/shell/face_boundary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

double widest(const shapes::Shape& shape) {
    const TargetSpace target = targets::target_of(shape);
    return widest_face_boundary(target) * target.frame().diagonal;
}

TEST(FaceBoundary, IsNoneOfClosedMeshes) {
    EXPECT_EQ(widest(shapes::icosphere(2)), 0);
    EXPECT_EQ(widest(shapes::torus_grid(12, 8)), 0);
}

TEST(FaceBoundary, IsAsWideAsTheSphereAroundIt) {
    EXPECT_NEAR(widest(shapes::grid(9, 9)), std::sqrt(2.0), 0.03);
    EXPECT_NEAR(widest(shapes::tube(24, 5)), 2, 0.05);  // one of two loops, not both
}

TEST(FaceBoundary, JoinsCornersAtTheSamePlace) {
    // Every face with corners of its own, one of them without area.
    const shapes::Shape joined = shapes::icosphere(1);
    shapes::Shape soup;
    for (const auto& f : joined.faces) {
        const int first = static_cast<int>(soup.positions.size());
        for (const int v : f) soup.positions.push_back(joined.positions[static_cast<std::size_t>(v)]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    soup.faces.push_back({0, 1, 1});
    EXPECT_EQ(widest(soup), 0);
}

TEST(FaceBoundary, IsNotThatOfAFin) {
    shapes::Shape finned = shapes::icosphere(1);
    const auto edge = finned.faces.front();
    finned.positions.emplace_back(3, 3, 3);
    finned.faces.push_back({edge[0], edge[1], static_cast<int>(finned.positions.size()) - 1});
    for (int repeated = 5; repeated < 9; ++repeated)
        finned.faces.push_back(finned.faces[static_cast<std::size_t>(repeated)]);
    EXPECT_EQ(widest(finned), 0);
}

}  // namespace
}  // namespace neuralmesh
