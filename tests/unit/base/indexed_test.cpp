// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/indexed.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace neuralmesh {
namespace {

TEST(Indexed, BehavesAsAVector) {
    Indexed<int> values(3, 7);
    values[1] = 5;
    values.push_back(9);
    EXPECT_EQ(values.size(), 4);
    EXPECT_EQ(values.back(), 9);
    EXPECT_EQ(values.vector(), (std::vector<int>{7, 5, 7, 9}));
    EXPECT_EQ(values, (Indexed<int>{7, 5, 7, 9}));
    EXPECT_NE(values, (Indexed<int>{7, 5, 7}));
    EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0), 28);
    EXPECT_EQ(values.data(), &values[0]);
}

TEST(Indexed, ResizeKeepsValuesAndAssignReplacesThem) {
    Indexed<int> values{1, 2};
    values.resize(4, 8);
    EXPECT_EQ(values, (Indexed<int>{1, 2, 8, 8}));
    values.resize(1);
    EXPECT_EQ(values, (Indexed<int>{1}));
    values.assign(2, 6);
    EXPECT_EQ(values, (Indexed<int>{6, 6}));
    values.clear();
    EXPECT_TRUE(values.empty());
}

TEST(Indexed, StartsWithDefaultValues) {
    const Indexed<double> zeros(2);
    EXPECT_EQ(zeros, (Indexed<double>{0, 0}));
}

#ifndef NDEBUG
TEST(IndexedDeathTest, AssertsTheRange) {
    Indexed<int> values(2);
    EXPECT_DEATH(values[2] = 1, "");
    EXPECT_DEATH(values[-1] = 1, "");
}
#endif

}  // namespace
}  // namespace neuralmesh
