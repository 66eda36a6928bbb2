// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/bits.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

TEST(Bits, AreThoseOfIeee754) {
    EXPECT_EQ(bit_cast<std::uint32_t>(1.0F), 0x3f800000U);
    EXPECT_EQ(bit_cast<std::uint32_t>(-0.0F), 0x80000000U);
    EXPECT_EQ(bit_cast<std::uint64_t>(-2.0), 0xc000000000000000U);
    EXPECT_EQ(bit_cast<float>(0x7f800000U), std::numeric_limits<float>::infinity());
    EXPECT_EQ(bit_cast<double>(std::uint64_t{1}), std::numeric_limits<double>::denorm_min());
}

TEST(Bits, SurviveConversionThereAndBack) {
    Random random(1);
    for (int i = 0; i < 10000; ++i) {
        const std::uint64_t word = std::uint64_t{random.bits()} << 32 | random.bits();
        EXPECT_EQ(bit_cast<std::uint64_t>(bit_cast<double>(word)), word);
    }
}

}  // namespace
}  // namespace neuralmesh
