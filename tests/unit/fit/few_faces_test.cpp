// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/few_faces.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

Vector3 in_cube(Random& random) { return to_eigen(vcg::Point3f::Construct(shapes::in_cube(random))); }

TEST(FewFaces, FindTheNearestForEightPoints) {
    Random random(3);
    for (int run = 0; run < 500; ++run) {
        FewFaces faces;
        std::vector<std::array<Vector3, 3>> plain;
        for (int i = 0; i <= run % Ring::kMaxValence; ++i) {
            plain.push_back({in_cube(random), in_cube(random), in_cube(random)});
            faces.add(plain.back()[0], plain.back()[1], plain.back()[2], 7 * i);
        }
        std::array<Vector3, PointPacket::kPoints> points;
        PointPacket packet;
        for (std::size_t lane = 0; lane < points.size(); ++lane) {
            points[lane] = in_cube(random);
            packet.set(lane, points[lane]);
        }
        FewFaces::Nearest nearest;
        faces.find_nearest(packet, nearest);
        for (std::size_t lane = 0; lane < points.size(); ++lane) {
            const auto squared = [&](std::size_t i) {
                return foot_on_triangle(points[lane], plain[i][0], plain[i][1], plain[i][2]).squared_distance;
            };
            std::size_t least = 0;
            for (std::size_t i = 1; i < plain.size(); ++i)
                if (squared(i) < squared(least)) least = i;
            ASSERT_EQ(nearest.label[lane], 7 * static_cast<int>(least));
            ASSERT_EQ(nearest.squared_distance[lane], squared(least));
        }
    }
}

TEST(FewFaces, PreferTheFirstAmongEquals) {
    const Vector3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    FewFaces faces;
    faces.add(o, x, z, 4);
    faces.add(o, x, y, 5);
    PointPacket packet;
    packet.set(0, {0.5F, 0, -1});    // nearest to the edge of both
    packet.set(1, {0.5F, 0.5F, 0});  // on the second
    FewFaces::Nearest nearest;
    faces.find_nearest(packet, nearest);
    EXPECT_EQ(nearest.label[0], 4);
    EXPECT_EQ(nearest.label[1], 5);
}

}  // namespace
}  // namespace neuralmesh
