// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Every point lies in exactly one slab, and all slabs hold equally many points of the sample.
#include "vcg_core/engine/slab_schedule.h"

#include <gtest/gtest.h>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

std::vector<vcg::Point3f> random_points(int count) {
    Random random(1);
    std::vector<vcg::Point3f> points;
    for (int i = 0; i < count; ++i) {
        const float x = random.unit();
        const float y = random.unit();
        // Longest along z, and denser towards 0.
        const float z = random.unit();
        points.emplace_back(x, y, 3 * z * z);
    }
    return points;
}

TEST(AxisPartition, SharesASampleEvenly) {
    const auto points = random_points(12000);
    AxisPartition slabs(points);
    for (const int count : {1, 2, 3, 8}) {
        slabs.cut(count);
        ASSERT_EQ(slabs.count(), count);
        std::vector<int> held(static_cast<std::size_t>(count), 0);
        for (const vcg::Point3f& p : points) ++held[static_cast<std::size_t>(slabs.of(p))];
        for (const int h : held) EXPECT_NEAR(h, 12000 / count, 1);
    }
    slabs.cut(4);
    EXPECT_EQ(slabs.of({0.9F, 0.1F, -5}), 0);
    EXPECT_EQ(slabs.of({0.1F, 0.9F, 5}), 3);
}

TEST(AxisPartition, HoldsEveryPointOnce) {
    AxisPartition slabs(random_points(100));
    slabs.cut(5);
    for (const vcg::Point3f& p : random_points(1000)) {
        int holders = 0;
        for (int i = 0; i < slabs.count(); ++i) holders += slabs.range(i).holds(p) ? 1 : 0;
        EXPECT_EQ(holders, 1);
    }
}

TEST(AxisPartition, HoldsEveryPointOfASampleWithoutExtent) {
    for (const auto& sample : {std::vector<vcg::Point3f>{}, std::vector<vcg::Point3f>(50, {1, 2, 3})}) {
        AxisPartition slabs(sample);
        slabs.cut(3);
        for (const vcg::Point3f& p : {vcg::Point3f(1, 2, 3), vcg::Point3f(0, 0, 0), vcg::Point3f(9, 9, 9)}) {
            EXPECT_GE(slabs.of(p), 0);
            EXPECT_LT(slabs.of(p), 3);
        }
    }
}

}  // namespace
}  // namespace neuralmesh
