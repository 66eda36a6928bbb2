// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace neuralmesh {
namespace {

TEST(Random, GivesTheSameNumbersOnEveryPlatform) {
    Random random(1);
    for (const std::uint32_t expected : {4142164973u, 2600129076u, 2454374945u, 111077108u})
        EXPECT_EQ(random.bits(), expected);
}

TEST(Random, BelowIsUniform) {
    constexpr std::uint32_t kValues = 7;
    constexpr int kDraws = 70000;
    std::array<int, kValues> seen{};
    Random random(3);
    for (int i = 0; i < kDraws; ++i) {
        const std::uint32_t value = random.below(kValues);
        ASSERT_LT(value, kValues);
        ++seen[value];
    }
    // Five standard deviations of a binomial distribution.
    for (const int count : seen) EXPECT_NEAR(count, 10000, 5 * std::sqrt(10000 * 6.0 / 7));
}

TEST(Random, UnitIsAMultipleOfItsStepBelowOne) {
    Random random(4);
    double sum = 0;
    for (int i = 0; i < 100000; ++i) {
        const float value = random.unit();
        ASSERT_TRUE(value >= 0 && value < 1);
        ASSERT_EQ(std::floor(value * 0x1p24F), value * 0x1p24F);
        sum += static_cast<double>(value);
    }
    EXPECT_NEAR(sum / 100000, 0.5, 0.005);
}

}  // namespace
}  // namespace neuralmesh
