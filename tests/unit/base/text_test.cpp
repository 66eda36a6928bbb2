// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/text.h"

#include <gtest/gtest.h>

namespace neuralmesh {
namespace {

TEST(Text, APercentageHasOneDecimal) {
    EXPECT_EQ(percent(0), "0.0 %");
    EXPECT_EQ(percent(0.0344), "3.4 %");
    EXPECT_EQ(percent(0.0996), "10.0 %");
    EXPECT_EQ(percent(1), "100.0 %");
}

}  // namespace
}  // namespace neuralmesh
